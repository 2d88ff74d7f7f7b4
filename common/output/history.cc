#include <common/output/history.h>
#include <common/output/run_directory.h>
#include <common/output/units.h>
#include <common/parallel/collective_error.h>

#include <deal.II/base/hdf5.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <sstream>
#include <type_traits>

namespace Friction
{
  namespace
  {
    using Q = Quantity;

    // All columns of a table: a name, what it is, its quantity, and the member
    // of the record.
    template <int dim, typename F>
    void
    for_each_level_column(const bool has_load_steps, const F &column)
    {
      using R = LevelRecord;
      column("level", "level of refinement", Q::number, &R::level);
      if (has_load_steps)
        {
          column("load_step", "load step", Q::number, &R::load_step);
          column("time", "time of the scene", Q::number, &R::time);
        }
      column("cells", "cells", Q::number, &R::cells);
      column("dofs", "degrees of freedom", Q::number, &R::dofs);
      column("contact_nodes", "nodes in contact", Q::number, &R::contact_nodes);
      column("sticky_nodes", "nodes that stick", Q::number, &R::sticky_nodes);
      column("outer_iterations",
             "outer iterations",
             Q::number,
             &R::outer_iterations);
      column("attempts", "methods tried", Q::number, &R::attempts);
      column("cycles", "multigrid cycles", Q::number, &R::cycles);
      column("contraction",
             "mean contraction of increments per cycle",
             Q::number,
             &R::contraction);
      column("rho_tau",
             "mean relative change of the normal forces per outer iteration",
             Q::number,
             &R::rho_tau);
      column("rho_tau_contraction",
             "contraction of these changes",
             Q::number,
             &R::rho_tau_contraction);
      column("energy",
             "elastic energy and work of friction minus work of loads",
             Q::energy,
             &R::energy);
      column("algebraic_error",
             "error of the iteration in the energy norm, extrapolated",
             Q::energy_norm,
             &R::algebraic_error);
      column("normal_force", "total normal force", Q::force, &R::normal_force);
      column("tangential_force",
             "norm of the total tangential force",
             Q::force,
             &R::tangential_force);
      column(
        "max_pressure", "peak contact pressure", Q::stress, &R::max_pressure);
      column("contact_half_width",
             dim == 2 ? "half-width of the contact zone"
                      : "radius of a disc as large as the contact zone",
             Q::length,
             &R::contact_half_width);
      column("stick_half_width",
             dim == 2 ? "half-width of the zone that sticks"
                      : "radius of a disc as large as the zone that sticks",
             Q::length,
             &R::stick_half_width);
      column("normal_force_error",
             "estimated error of normal_force, negative if unknown",
             Q::force,
             &R::normal_force_error);
      column("tangential_force_error",
             "estimated error of tangential_force, negative if unknown",
             Q::force,
             &R::tangential_force_error);
      column("max_pressure_error",
             "estimated error of max_pressure, negative if unknown",
             Q::stress,
             &R::max_pressure_error);
      column("contact_half_width_error",
             "estimated error of contact_half_width, negative if unknown",
             Q::length,
             &R::contact_half_width_error);
      column("stick_half_width_error",
             "estimated error of stick_half_width, negative if unknown",
             Q::length,
             &R::stick_half_width_error);
      column("pressure_resolution",
             "what the distance of nodes leaves open of max_pressure",
             Q::stress,
             &R::pressure_resolution);
      column("contact_resolution",
             "what the distance of nodes leaves open of contact_half_width",
             Q::length,
             &R::contact_resolution);
      column("stick_resolution",
             "what the distance of nodes leaves open of stick_half_width",
             Q::length,
             &R::stick_resolution);
      column("estimated_error",
             "estimated error of the displacement in the energy norm",
             Q::energy_norm,
             &R::estimated_error);
      column("error_at_least",
             "what that error is at least, as far as the mesh can tell",
             Q::energy_norm,
             &R::error_at_least);
      column("certificate",
             "largest violation of the discrete law, of the peak pressure",
             Q::number,
             &R::certificate);
      column("setup_seconds", "time to set up", Q::time, &R::setup_seconds);
      column("solve_seconds", "time to solve", Q::time, &R::solve_seconds);
    }



    template <typename F>
    void
    for_each_cycle_column(const F &column)
    {
      using R = CycleRecord;
      column("level", "level of refinement", Q::number, &R::level);
      column("increment",
             "energy norm of the increment, of that of the displacement",
             Q::number,
             &R::increment);
      column("energy", "energy after smoothing", Q::energy, &R::energy);
      column("damping",
             "step length of the coarse correction",
             Q::number,
             &R::step_length);
      column("truncated",
             "components without coarse correction",
             Q::number,
             &R::truncated);
      column("residual",
             "Euclidean norm of the truncated residual",
             Q::force,
             &R::residual);
    }



    template <typename F>
    void
    for_each_outer_column(const F &column)
    {
      using R = OuterRecord;
      column("level", "level of refinement", Q::number, &R::level);
      column("change",
             "relative change of the normal forces",
             Q::number,
             &R::change);
    }



    template <int dim, typename F>
    void
    for_each_contact_column(const bool several, const F &column)
    {
      using R = ContactRecord<dim>;
      column("point", "place of the node", Q::length, &R::point);
      column("normal",
             "direction of contact, from the body to the obstacle",
             Q::number,
             &R::normal);
      column("displacement", "displacement", Q::length, &R::displacement);
      column("slip", "slip along the obstacle", Q::length, &R::slip);
      column("force", "force of the obstacle on the node", Q::force, &R::force);
      column("gap", "gap along the normal", Q::length, &R::gap);
      column("measure", "boundary around the node", Q::area, &R::measure);
      column("friction_bound",
             "largest tangential stress that friction allows",
             Q::stress,
             &R::friction_bound);
      column("state", "0 open, 1 slides, 2 sticks", Q::number, &R::state);
      if (several)
        column("section",
               "of the scene: 1 Contact, 2 Contact 2, ...",
               Q::number,
               &R::section);
    }



    // The forces are the same on all levels.
    template <int dim, typename F>
    void
    for_each_force_column(const ForceBalance<dim> &balance, const F &column)
    {
      using R = ForceRecord<dim>;
      column("level", "level of refinement", Q::number, &R::level);
      for (unsigned int i = 0; i < balance.forces.size(); ++i)
        {
          const ForceOnBody<dim> &force = balance.forces[i];
          column(force.name,
                 "force " + force.description + " on the body",
                 Q::force,
                 [i](const R &r) { return r.balance.forces[i].total; });
          if (force.is_platen)
            column("platen" + force.name.substr(std::string("held").size()),
                   "how far it was moved from where 'Displacement' has it",
                   Q::length,
                   [i](const R &r) { return r.balance.forces[i].moved; });
          if (!force.is_contact)
            continue;
          column(force.name + "_normal",
                 "sum of the normal forces " + force.description,
                 Q::force,
                 [i](const R &r) { return r.balance.forces[i].normal; });
          column(force.name + "_tangential",
                 "sum of the tangential forces " + force.description,
                 Q::force,
                 [i](const R &r) { return r.balance.forces[i].tangential; });
        }
      column("sum", "sum of all forces on the body", Q::force, [](const R &r) {
        return r.balance.sum();
      });
      column("imbalance",
             "their sum, of the largest force",
             Q::number,
             [](const R &r) { return r.balance.imbalance(); });
    }



    // One dataset with a number of each record.
    template <typename Number>
    std::enable_if_t<std::is_arithmetic_v<Number>, dealii::HDF5::DataSet>
    write_values(const dealii::HDF5::Group &group,
                 const std::string         &name,
                 const std::vector<Number> &values)
    {
      auto data = group.create_dataset<Number>(name, {values.size()});
      data.write(values);
      return data;
    }

    // The same with a vector or a point of each: one row each.
    template <typename VectorType>
    std::enable_if_t<!std::is_arithmetic_v<VectorType>, dealii::HDF5::DataSet>
    write_values(const dealii::HDF5::Group     &group,
                 const std::string             &name,
                 const std::vector<VectorType> &values)
    {
      dealii::FullMatrix<double> rows(values.size(), VectorType::dimension);
      for (unsigned int i = 0; i < rows.m(); ++i)
        for (unsigned int c = 0; c < rows.n(); ++c)
          rows(i, c) = values[i][c];
      auto data = group.create_dataset<double>(name, {rows.m(), rows.n()});
      data.write(rows);
      return data;
    }



    // Writes a column of a table as a dataset that says what it is, if there
    // are names of units.
    template <typename Record>
    class ColumnWriter
    {
    public:
      ColumnWriter(const dealii::HDF5::Group   &group,
                   const std::vector<Record>   &records,
                   const unsigned int           dim,
                   const Parameters::UnitNames *units)
        : group(group)
        , records(records)
        , dim(dim)
        , units(units)
      {}

      template <typename Member>
      void
      operator()(const std::string &name,
                 const std::string &label,
                 const Quantity     quantity,
                 const Member       member) const
      {
        std::vector<std::decay_t<std::invoke_result_t<Member, const Record &>>>
          values;
        values.reserve(records.size());
        for (const Record &record : records)
          values.push_back(std::invoke(member, record));
        dealii::HDF5::DataSet data = write_values(group, name, values);
        if (units == nullptr)
          return;
        data.set_attribute("label", label);
        const std::string unit = unit_of(quantity, dim, *units);
        if (!unit.empty())
          data.set_attribute("units", unit);
      }

    private:
      const dealii::HDF5::Group    group;
      const std::vector<Record>   &records;
      const unsigned int           dim;
      const Parameters::UnitNames *units;
    };



    // The last record of each load step.
    std::vector<LevelRecord>
    ends_of_steps(const std::vector<LevelRecord> &levels)
    {
      std::vector<LevelRecord> ends;
      for (const LevelRecord &level : levels)
        {
          if (!ends.empty() && ends.back().load_step == level.load_step)
            ends.pop_back();
          ends.push_back(level);
        }
      return ends;
    }



    std::string
    two_digits(const unsigned int number)
    {
      return (number < 10 ? "0" : "") + std::to_string(number);
    }
  } // namespace



  template <int dim>
  History<dim>::History(const std::string    &file_name,
                        const RunDescription &description,
                        const MPI_Comm        communicator)
    : file_name(file_name)
    , description(description)
    , communicator(communicator)
  {}



  template <int dim>
  void
  History<dim>::add_level(const LevelRecord                     &level,
                          const std::vector<CycleRecord>        &cycles,
                          const std::vector<ContactRecord<dim>> &contact,
                          const std::vector<OuterRecord>        &outer,
                          const std::vector<ForceRecord<dim>>   &forces)
  {
    level_records.push_back(level);
    cycle_records.insert(cycle_records.end(), cycles.begin(), cycles.end());
    outer_records.insert(outer_records.end(), outer.begin(), outer.end());
    force_records.insert(force_records.end(), forces.begin(), forces.end());
    if (!contact.empty())
      {
        contact_levels.emplace_back();
        contact_levels.back().level = level.level;
        contact_levels.back().nodes = contact;
      }

    on_first_process(communicator, [&]() { write_file(); });
  }



  template <int dim>
  const std::vector<LevelRecord> &
  History<dim>::levels() const
  {
    return level_records;
  }



  template <int dim>
  std::size_t
  History<dim>::payload() const
  {
    std::size_t size = description.scene.size() +
      description.parameters.size() + description.version.size() +
      level_records.size() * (sizeof(LevelRecord) - 2 * sizeof(double)) +
      cycle_records.size() * (2 * sizeof(unsigned int) + 4 * sizeof(double)) +
      outer_records.size() * (sizeof(unsigned int) + sizeof(double));
    for (const ForceRecord<dim> &record : force_records)
      size += sizeof(unsigned int) +
        (record.balance.forces.size() + 1) * dim * sizeof(double);
    for (const ContactLevel &contact : contact_levels)
      size += contact.nodes.size() *
        ((5 * dim + 3) * sizeof(double) + sizeof(unsigned int));
    return size;
  }



  template <int dim>
  void
  History<dim>::write_file() const
  {
    write_then_rename(file_name, [&](const std::string &temporary) {
      // HDF5 meets a full disk at a moment of its own choice, with pages of
      // diagnosis, and in release mode deal.II's classes go on regardless. So
      // we first write a plain file that is certainly larger than the real
      // one will be; HDF5 then gets the room it has left.
      const std::size_t room = payload() + (1 << 14) +
        (1 << 13) * (contact_levels.size() + 4) +
        (force_records.empty()
           ? 0
           : (1 << 11) * (3 * force_records[0].balance.forces.size() + 4));
      {
        std::ofstream out(temporary, std::ios::binary);
        if (out)
          {
            const std::vector<char> block(1 << 12, 0);
            for (std::size_t written = 0; out && written < room;
                 written += block.size())
              out.write(block.data(), block.size());
            out.close();
          }
        if (!out)
          throw InputError(
            "The file '" + file_name +
            "' cannot be written: the disk is full or write-protected.");
      }

      write_hdf5(temporary);

      if (std::filesystem::file_size(temporary) < payload())
        throw InputError("The file '" + file_name +
                         "' cannot be written completely: is the disk full?");
    });
    write_stream_then_rename(
      (std::filesystem::path(file_name).parent_path() / "levels.csv").string(),
      [&](std::ostream &out) { write_csv(out); });
  }



  template <int dim>
  void
  History<dim>::write_hdf5(const std::string &name) const
  {
    dealii::HDF5::File file(name, dealii::HDF5::File::FileAccessMode::create);
    file.set_attribute("scene", description.scene);
    file.set_attribute("parameters", description.parameters);
    file.set_attribute("version", description.version);
    file.set_attribute("dimension", static_cast<unsigned int>(dim));

    for_each_level_column<dim>(
      description.has_load_steps,
      ColumnWriter<LevelRecord>(
        file.create_group("levels"), level_records, dim, &description.units));
    if (description.has_load_steps)
      {
        const std::vector<LevelRecord> ends = ends_of_steps(level_records);
        for_each_level_column<dim>(
          true,
          ColumnWriter<LevelRecord>(
            file.create_group("steps"), ends, dim, &description.units));
      }
    if (!cycle_records.empty())
      for_each_cycle_column(ColumnWriter<CycleRecord>(
        file.create_group("cycles"), cycle_records, dim, &description.units));
    if (!outer_records.empty())
      for_each_outer_column(ColumnWriter<OuterRecord>(
        file.create_group("outer"), outer_records, dim, &description.units));

    if (!force_records.empty())
      for_each_force_column(
        force_records.back().balance,
        ColumnWriter<ForceRecord<dim>>(
          file.create_group("forces"), force_records, dim, &description.units));

    if (!contact_levels.empty())
      {
        const dealii::HDF5::Group all_levels = file.create_group("contact");
        for (const ContactLevel &contact : contact_levels)
          for_each_contact_column<dim>(
            description.n_contact_boundaries > 1,
            ColumnWriter<ContactRecord<dim>>(
              all_levels.create_group("level_" + two_digits(contact.level)),
              contact.nodes,
              dim,
              &contact == &contact_levels.back() ? &description.units
                                                 : nullptr));
      }
  }



  template <int dim>
  void
  History<dim>::write_csv(std::ostream &out) const
  {
    std::vector<std::string> lines(level_records.size() + 1);
    const auto               column = [&](const std::string &name,
                            const std::string               &/*label*/,
                            const Quantity quantity,
                            const auto     member) {
      const std::string unit = unit_of(quantity, dim, description.units);
      const std::string header = unit.empty() ? name : name + " [" + unit + ']';
      lines[0] += (lines[0].empty() ? "" : ",") + header;
      for (unsigned int i = 0; i < level_records.size(); ++i)
        {
          std::ostringstream value;
          value << std::setprecision(12) << level_records[i].*member;
          lines[i + 1] += (lines[i + 1].empty() ? "" : ",") + value.str();
        }
    };
    for_each_level_column<dim>(description.has_load_steps, column);
    for (const std::string &line : lines)
      out << line << '\n';
  }



  template class History<2>;
  template class History<3>;
} // namespace Friction
