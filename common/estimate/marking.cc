#include <common/compatibility.h>
#include <common/estimate/marking.h>

#include <deal.II/base/mpi.h>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    // Errors are stored in single precision, and come from sums in an order
    // that depends on the mesh: what agrees to this is the same.
    constexpr double rounding = 1e-4;



    template <int dim>
    double
    largest_error(const Triangulation<dim> &triangulation,
                  const Vector<float>      &cell_errors)
    {
      AssertDimension(cell_errors.size(), triangulation.n_active_cells());

      double largest = 0.;
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          largest = std::max(
            largest,
            static_cast<double>(cell_errors(cell->active_cell_index())));
      return Utilities::MPI::max(
        largest, Compatibility::mpi_communicator(triangulation));
    }



    template <int dim>
    unsigned int
    mark_above(Triangulation<dim>  &triangulation,
               const Vector<float> &cell_errors,
               const double         threshold)
    {
      unsigned int n_marked = 0;
      if (threshold > 0.)
        for (const auto &cell : triangulation.active_cell_iterators())
          if (cell->is_locally_owned() &&
              cell_errors(cell->active_cell_index()) >= threshold)
            {
              cell->set_refine_flag();
              ++n_marked;
            }
      return Utilities::MPI::sum(
        n_marked, Compatibility::mpi_communicator(triangulation));
    }
  } // namespace



  template <int dim>
  unsigned int
  mark_by_maximum(Triangulation<dim>  &triangulation,
                  const Vector<float> &cell_errors,
                  const double         theta)
  {
    Assert(theta > 0. && theta <= 1., ExcMessage("theta must be in (0,1]."));
    return mark_above(triangulation,
                      cell_errors,
                      (1. - rounding) * theta *
                        largest_error(triangulation, cell_errors));
  }



  template unsigned int
  mark_by_maximum<2>(Triangulation<2> &, const Vector<float> &, const double);
  template unsigned int
  mark_by_maximum<3>(Triangulation<3> &, const Vector<float> &, const double);



  template <int dim>
  bool
  mark_contact_zone(const Discretization<dim> &discretization,
                    const ContactState        &state)
  {
    // Each process knows what its own nodes do, but its cells have vertices
    // that belong to others.
    const ContactBoundary<dim> &contact = discretization.contact();
    VectorType                  touches(discretization.vector());
    for (unsigned int p = 0; p < contact.size(); ++p)
      touches.local_element(dim * contact[p].node) =
        state.in_contact(p) ? 1. : 0.;
    touches.update_ghost_values();

    bool any_marked = false;
    for (const auto &cell :
         discretization.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        for (const unsigned int v : cell->vertex_indices())
          if (touches(cell->vertex_dof_index(v, 0)) > 0.)
            {
              cell->set_refine_flag();
              any_marked = true;
            }
    return Utilities::MPI::max(any_marked ? 1 : 0,
                               discretization.constraints().communicator()) > 0;
  }



  template bool mark_contact_zone(const Discretization<2> &,
                                  const ContactState &);
  template bool mark_contact_zone(const Discretization<3> &,
                                  const ContactState &);
} // namespace Friction
