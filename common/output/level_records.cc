#include <common/algorithms/safeguarded_solver.h>
#include <common/contact/contact_forces.h>
#include <common/output/level_records.h>
#include <common/parallel/run_clock.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <algorithm>
#include <array>
#include <cmath>

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



    // The records of all processes on the first one, in an order of their own.
    template <int dim>
    std::vector<ContactRecord<dim>>
    gather_sorted(const std::vector<ContactRecord<dim>> &own,
                  const MPI_Comm                         communicator)
    {
      std::vector<ContactRecord<dim>> all;
      for (const auto &part : Utilities::MPI::gather(communicator, own))
        all.insert(all.end(), part.begin(), part.end());

      std::sort(all.begin(), all.end(), [](const auto &a, const auto &b) {
        for (unsigned int d = 0; d < dim; ++d)
          if (a.point[d] != b.point[d])
            return a.point[d] < b.point[d];
        return false;
      });
      return all;
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
    records.matrix_memory = report.matrix_memory;
    records.solver_memory = report.solver_memory;
    LevelRecord &record   = records.level;
    record.level          = level;
    record.cells = dof_handler.get_triangulation().n_global_active_cells();
    record.dofs  = dof_handler.n_dofs();
    record.outer_iterations    = report.outer_iterations;
    record.cycles              = report.cycles.size();
    record.contraction         = report.contraction;
    record.energy              = report.energy;
    record.rho_tau             = report.rho_tau_as_printed();
    record.rho_tau_contraction = report.rho_tau_contraction();
    record.certificate         = report.certificate.largest();
    record.algebraic_error     = report.algebraic_error;
    record.attempts  = std::max<unsigned int>(1, report.attempts.size());
    records.attempts = describe_attempts(report);

    const MPI_Comm communicator = constraints.communicator();
    record.contact_nodes = Utilities::MPI::sum(state.n_contact(), communicator);
    record.sticky_nodes = Utilities::MPI::sum(state.n_sticking(), communicator);

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
        for (unsigned int d = 0; d < dim; ++d)
          row.displacement[d] = displacement.local_element(dim * node.node + d);
        row.force = contact_force(node, report.residual);
        row.state = !state.in_contact(p) ? 0 : state.sticks(p) ? 2 : 1;
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
