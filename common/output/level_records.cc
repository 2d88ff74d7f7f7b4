#include <common/algorithms/safeguarded_solver.h>
#include <common/contact/contact_forces.h>
#include <common/output/level_records.h>
#include <common/parallel/reductions.h>
#include <common/parallel/run_clock.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <type_traits>
#include <vector>

namespace Friction
{
  namespace
  {
    template <int dim>
    double
    half_width(const double measure)
    {
      return dim == 2 ? .5 * measure : std::sqrt(measure / numbers::PI);
    }



    // A record as numbers, to be sent: of other objects deal.II would pack each
    // member by itself.
    template <int dim>
    using Numbers = std::array<double, 5 * dim + 6>;



    // An archive, as ContactRecord::serialize() wants one, that calls a
    // function for each number.
    template <typename F>
    struct ForEachNumber
    {
      explicit ForEachNumber(const F &f)
        : f(f)
      {}

      const F f;

      template <typename T>
      ForEachNumber &
      operator&(T &x)
      {
        if constexpr (std::is_arithmetic_v<T>)
          f(x);
        else
          for (unsigned int d = 0; d < T::dimension; ++d)
            f(x[d]);
        return *this;
      }
    };



    template <int dim>
    Numbers<dim>
    to_numbers(ContactRecord<dim> record)
    {
      Numbers<dim>  numbers;
      auto          place = numbers.begin();
      ForEachNumber archive{[&](const auto x) { *place++ = x; }};
      record.serialize(archive, 0);
      Assert(place == numbers.end(), ExcInternalError());
      return numbers;
    }



    template <int dim>
    ContactRecord<dim>
    from_numbers(const Numbers<dim> &numbers)
    {
      ContactRecord<dim> record;
      auto               place = numbers.begin();
      ForEachNumber      archive{
        [&](auto &x) { x = static_cast<std::decay_t<decltype(x)>>(*place++); }};
      record.serialize(archive, 0);
      return record;
    }



    // The records of all processes on the first one, in an order of their own.
    template <int dim>
    std::vector<ContactRecord<dim>>
    gather_sorted(const std::vector<ContactRecord<dim>> &own,
                  const MPI_Comm                         communicator)
    {
      // A process by itself need not pack its records in order to keep them.
      std::vector<ContactRecord<dim>> all;
      if (Utilities::MPI::n_mpi_processes(communicator) == 1)
        all = own;
      else
        {
          // Utilities::MPI::gather() would compress them.
          std::map<unsigned int, std::vector<Numbers<dim>>> numbers;
          for (const ContactRecord<dim> &record : own)
            numbers[0].push_back(to_numbers(record));
          for (const auto &part :
               Utilities::MPI::some_to_some(communicator, numbers))
            for (const Numbers<dim> &record : part.second)
              all.push_back(from_numbers<dim>(record));
        }

      std::sort(all.begin(), all.end(), [](const auto &a, const auto &b) {
        for (unsigned int d = 0; d < dim; ++d)
          if (a.point[d] != b.point[d])
            return a.point[d] < b.point[d];
        return false;
      });
      return all;
    }
    // What the neighbours of contact nodes do, on this process and others, says
    // where zones end, and how far the largest pressure stands out.
    template <int dim>
    void
    set_resolutions(LevelRecord               &record,
                    const Discretization<dim> &discretization,
                    const ContactState        &state,
                    const VectorType          &residual)
    {
      const ContactBoundary<dim> &contact = discretization.contact();
      const NodeBlockMatrix<dim> &A       = discretization.stiffness().blocks();
      const MPI_Comm comm = discretization.constraints().communicator();

      // Of each node a phase, which is zero where there can be no contact, and
      // a pressure.
      constexpr double open = 1, slides = 2, sticks = 3;
      VectorType       values = discretization.vector();
      for (unsigned int p = 0; p < contact.size(); ++p)
        {
          const unsigned int i    = dim * contact[p].node;
          values.local_element(i) = !state.in_contact(p) ? open
            : state.sticks(p)                            ? sticks
                                                         : slides;
          if (state.in_contact(p))
            values.local_element(i + 1) =
              normal_component(contact[p], residual) / contact[p].measure;
        }
      discretization.stiffness().update_ghosts(values);

      // Half of what stands at the rims of both zones, the measures of the
      // zones themselves, and the peak.
      std::array<double, 4> sums{};
      double                peak = 0, stands_out = 0;
      for (unsigned int p = 0; p < contact.size(); ++p)
        {
          const unsigned int node  = contact[p].node;
          const double       phase = values.local_element(dim * node);
          const double       m     = contact[p].measure;
          if (phase < slides)
            continue;
          bool         next_to_open = false, next_to_slip = false;
          double       sum = 0;
          unsigned int n   = 0;
          for (std::size_t e = A.row_begin(node) + 1; e < A.row_end(node); ++e)
            {
              const unsigned int j     = dim * A.column(e);
              const double       other = values.local_element(j);
              if (other < open)
                continue;
              next_to_open = next_to_open || other == open;
              next_to_slip = next_to_slip || other < sticks;
              sum += values.local_element(j + 1);
              ++n;
            }
          sums[0] += m;
          sums[1] += next_to_open ? .5 * m : 0.;
          sums[2] += phase == sticks ? m : 0.;
          sums[3] += phase == sticks && next_to_slip ? .5 * m : 0.;
          const double pressure = values.local_element(dim * node + 1);
          if (pressure > peak)
            {
              peak       = pressure;
              stands_out = std::abs(pressure - (n > 0 ? sum / n : 0.));
            }
        }
      sums                 = sum_over_processes(sums, comm);
      const double highest = max_over_processes(peak, comm);
      record.pressure_resolution =
        max_over_processes(peak == highest ? stands_out : 0., comm);

      // The derivative of the half-width with respect to the measure.
      const auto resolution = [&](const double zone, const double rim) {
        return zone > 0 ? rim * half_width<dim>(zone) / ((dim - 1) * zone) : 0.;
      };
      record.contact_resolution = resolution(sums[0], sums[1]);
      record.stick_resolution   = resolution(sums[2], sums[3]);
    }
  } // namespace



  template <int dim>
  LevelRecords<dim>
  make_level_records(const unsigned int         level,
                     const Discretization<dim> &discretization,
                     const VectorType          &displacement,
                     const ContactState        &state,
                     const SolverReport        &report)
  {
    const DoFHandler<dim>       &dof_handler = discretization.dof_handler();
    const NodalConstraints<dim> &constraints = discretization.constraints();
    const ContactBoundary<dim>  &contact_boundary = discretization.contact();
    const RunScope    part(constraints.communicator(), RunPart::records);
    LevelRecords<dim> records;

    records.costs         = report.costs;
    records.matrix_memory = discretization.stiffness().memory_consumption();
    records.solver_memory = report.solver_memory;
    LevelRecord &record   = records.level;
    record.level          = level;
    record.load_step      = discretization.scene().load_step() + 1;
    record.time           = discretization.scene().time();
    record.cells = dof_handler.get_triangulation().n_global_active_cells();
    record.dofs  = dof_handler.n_dofs();
    record.outer_iterations    = report.outer_iterations;
    record.cycles              = report.cycles.size();
    record.contraction         = report.contraction;
    record.pace                = report.pace;
    record.energy              = report.energy;
    record.rho_tau             = report.rho_tau_as_printed();
    record.rho_tau_contraction = report.rho_tau_contraction();
    record.certificate         = report.certificate.largest();
    record.algebraic_error     = report.algebraic_error;
    record.next_method         = static_cast<unsigned int>(report.next_method);
    record.attempts  = std::max<unsigned int>(1, report.attempts.size());
    records.attempts = describe_attempts(report);

    const MPI_Comm communicator = constraints.communicator();
    record.contact_nodes = Utilities::MPI::sum(state.n_contact(), communicator);
    record.sticky_nodes = Utilities::MPI::sum(state.n_sticking(), communicator);

    set_resolutions(record, discretization, state, report.residual);

    // What is summed up over the nodes, here of this process.
    Tensor<1, dim> tangential_force;
    double         normal_force = 0, max_pressure = 0;
    double         contact_measure = 0, stick_measure = 0;
    for (unsigned int p = 0; p < contact_boundary.size(); ++p)
      {
        const ContactNode<dim> &node = contact_boundary[p];
        ContactRecord<dim>      row;
        row.dof   = constraints.partitioner()->local_to_global(dim * node.node);
        row.point = node.point;
        row.normal  = node.normal();
        row.gap     = node.gap;
        row.measure = node.measure;
        row.section =
          discretization.scene().contact_conditions()[node.condition].number;
        row.slip_origin = node.slip_origin;
        for (unsigned int d = 0; d < dim; ++d)
          row.displacement[d] = displacement.local_element(dim * node.node + d);
        row.force = contact_force(node, report.residual);
        row.state = !state.in_contact(p) ? 0 : state.sticks(p) ? 2 : 1;
        row.friction_bound =
          discretization.problem().effective_coefficient(node) *
          state.normal_force(p) / node.measure;
        records.own_contact.push_back(row);

        const double pressing = -row.force * row.normal;
        tangential_force += row.force + pressing * row.normal;
        if (row.state > 0)
          {
            normal_force += pressing;
            max_pressure = std::max(max_pressure, pressing / row.measure);
            contact_measure += row.measure;
            if (row.state == 2)
              stick_measure += row.measure;
          }
      }
    records.contact = gather_sorted(records.own_contact, communicator);

    // And now of all.
    record.normal_force = Utilities::MPI::sum(normal_force, communicator);
    record.max_pressure = Utilities::MPI::max(max_pressure, communicator);
    record.tangential_force =
      Utilities::MPI::sum(tangential_force, communicator).norm();
    record.contact_half_width =
      half_width<dim>(Utilities::MPI::sum(contact_measure, communicator));
    record.stick_half_width =
      half_width<dim>(Utilities::MPI::sum(stick_measure, communicator));

    for (const CycleInfo &info : report.cycles)
      {
        CycleRecord row;
        row.level       = level;
        row.increment   = info.increment;
        row.energy      = info.energy;
        row.step_length = info.step_length;
        row.truncated   = info.truncated;
        row.residual    = info.residual;
        records.cycles.push_back(row);
      }
    for (const double change : report.outer_changes)
      {
        OuterRecord row;
        row.level  = level;
        row.change = change;
        records.outer.push_back(row);
      }
    return records;
  }



  template LevelRecords<2> make_level_records(const unsigned int,
                                              const Discretization<2> &,
                                              const VectorType &,
                                              const ContactState &,
                                              const SolverReport &);
  template LevelRecords<3> make_level_records(const unsigned int,
                                              const Discretization<3> &,
                                              const VectorType &,
                                              const ContactState &,
                                              const SolverReport &);
} // namespace Friction
