#include <common/output/history.h>
#include <common/output/run_directory.h>
#include <common/parallel/collective_error.h>

#include <deal.II/base/hdf5.h>

#include <filesystem>
#include <fstream>

namespace Friction
{
  namespace
  {
    // One dataset: the same member of every record.
    template <typename Record, typename Number>
    void
    write_column(const dealii::HDF5::Group &group,
                 const std::string         &name,
                 const std::vector<Record> &records,
                 Number Record::*const member)
    {
      std::vector<Number> values;
      values.reserve(records.size());
      for (const Record &record : records)
        values.push_back(record.*member);
      group.write_dataset(name, values);
    }



    // The same for a member with dim components: one row per record.
    template <typename Record, typename VectorType>
    void
    write_rows(const dealii::HDF5::Group &group,
               const std::string         &name,
               const std::vector<Record> &records,
               VectorType Record::*const member)
    {
      dealii::FullMatrix<double> values(records.size(), VectorType::dimension);
      for (unsigned int i = 0; i < values.m(); ++i)
        for (unsigned int c = 0; c < values.n(); ++c)
          values(i, c) = (records[i].*member)[c];
      group.write_dataset(name, values);
    }



    std::string
    two_digits(const unsigned int number)
    {
      return (number < 10 ? "0" : "") + std::to_string(number);
    }
  } // namespace



  template <int dim>
  History<dim>::History(const std::string &file_name,
                        const std::string &scene,
                        const std::string &parameters,
                        const std::string &version,
                        const MPI_Comm     communicator)
    : file_name(file_name)
    , scene(scene)
    , parameters(parameters)
    , version(version)
    , communicator(communicator)
  {}



  template <int dim>
  void
  History<dim>::add_level(const LevelRecord                     &level,
                          const std::vector<CycleRecord>        &cycles,
                          const std::vector<ContactRecord<dim>> &contact,
                          const std::vector<OuterRecord>        &outer)
  {
    level_records.push_back(level);
    cycle_records.insert(cycle_records.end(), cycles.begin(), cycles.end());
    outer_records.insert(outer_records.end(), outer.begin(), outer.end());
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
    std::size_t size = scene.size() + parameters.size() + version.size() +
      level_records.size() * sizeof(LevelRecord) +
      cycle_records.size() * (2 * sizeof(unsigned int) + 4 * sizeof(double)) +
      outer_records.size() * (sizeof(unsigned int) + sizeof(double));
    for (const ContactLevel &contact : contact_levels)
      size += contact.nodes.size() *
        ((4 * dim + 2) * sizeof(double) + sizeof(unsigned int));
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
      const std::size_t room =
        payload() + (1 << 14) + (1 << 13) * (contact_levels.size() + 4);
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
  }



  template <int dim>
  void
  History<dim>::write_hdf5(const std::string &name) const
  {
    dealii::HDF5::File file(name, dealii::HDF5::File::FileAccessMode::create);
    file.set_attribute("scene", scene);
    file.set_attribute("parameters", parameters);
    file.set_attribute("version", version);

    {
      const dealii::HDF5::Group group = file.create_group("levels");
      const auto write = [&](const std::string &column, const auto member) {
        write_column(group, column, level_records, member);
      };
      write("level", &LevelRecord::level);
      write("cells", &LevelRecord::cells);
      write("dofs", &LevelRecord::dofs);
      write("contact_nodes", &LevelRecord::contact_nodes);
      write("sticky_nodes", &LevelRecord::sticky_nodes);
      write("outer_iterations", &LevelRecord::outer_iterations);
      write("attempts", &LevelRecord::attempts);
      write("cycles", &LevelRecord::cycles);
      write("contraction", &LevelRecord::contraction);
      write("rho_tau", &LevelRecord::rho_tau);
      write("rho_tau_contraction", &LevelRecord::rho_tau_contraction);
      write("energy", &LevelRecord::energy);
      write("algebraic_error", &LevelRecord::algebraic_error);
      write("normal_force", &LevelRecord::normal_force);
      write("tangential_force", &LevelRecord::tangential_force);
      write("max_pressure", &LevelRecord::max_pressure);
      write("contact_half_width", &LevelRecord::contact_half_width);
      write("stick_half_width", &LevelRecord::stick_half_width);
      write("normal_force_error", &LevelRecord::normal_force_error);
      write("tangential_force_error", &LevelRecord::tangential_force_error);
      write("max_pressure_error", &LevelRecord::max_pressure_error);
      write("contact_half_width_error", &LevelRecord::contact_half_width_error);
      write("stick_half_width_error", &LevelRecord::stick_half_width_error);
      write("pressure_resolution", &LevelRecord::pressure_resolution);
      write("contact_resolution", &LevelRecord::contact_resolution);
      write("stick_resolution", &LevelRecord::stick_resolution);
      write("estimated_error", &LevelRecord::estimated_error);
      write("certificate", &LevelRecord::certificate);
      write("setup_seconds", &LevelRecord::setup_seconds);
      write("solve_seconds", &LevelRecord::solve_seconds);
    }

    if (!cycle_records.empty())
      {
        const dealii::HDF5::Group group = file.create_group("cycles");
        const auto write = [&](const std::string &column, const auto member) {
          write_column(group, column, cycle_records, member);
        };
        write("level", &CycleRecord::level);
        write("increment", &CycleRecord::increment);
        write("energy", &CycleRecord::energy);
        write("damping", &CycleRecord::step_length);
        write("truncated", &CycleRecord::truncated);
        write("residual", &CycleRecord::residual);
      }

    if (!outer_records.empty())
      {
        const dealii::HDF5::Group group = file.create_group("outer");
        write_column(group, "level", outer_records, &OuterRecord::level);
        write_column(group, "change", outer_records, &OuterRecord::change);
      }

    if (!contact_levels.empty())
      {
        using Record = ContactRecord<dim>;

        const dealii::HDF5::Group all_levels = file.create_group("contact");
        for (const ContactLevel &contact : contact_levels)
          {
            const dealii::HDF5::Group group =
              all_levels.create_group("level_" + two_digits(contact.level));
            write_rows(group, "point", contact.nodes, &Record::point);
            write_rows(group, "normal", contact.nodes, &Record::normal);
            write_rows(
              group, "displacement", contact.nodes, &Record::displacement);
            write_rows(group, "force", contact.nodes, &Record::force);
            write_column(group, "gap", contact.nodes, &Record::gap);
            write_column(group, "measure", contact.nodes, &Record::measure);
            write_column(group, "state", contact.nodes, &Record::state);
          }
      }
  }



  template class History<2>;
  template class History<3>;
} // namespace Friction
