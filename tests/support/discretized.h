#ifndef friction_tests_support_discretized_h
#define friction_tests_support_discretized_h

#include <common/contact/contact_state.h>
#include <common/discretization/discretization.h>
#include <common/iteration/monotone_smoother.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Tests
{
  using namespace dealii;
  using namespace Friction;

  /** A scene discretised and assembled on a mesh. */
  template <int dim>
  class Discretized : public Discretization<dim>
  {
  public:
    Discretized(const Scene<dim> &scene, const Triangulation<dim> &mesh)
      : Discretization<dim>(scene, mesh)
    {
      this->set_up();
      this->assemble(elasticity<dim>(scene.materials()));
    }
  };



  /** Zero, but for prescribed values, and moved out of the obstacle. */
  template <int dim>
  VectorType
  admissible_start(const Discretization<dim> &d)
  {
    VectorType u = d.vector();
    d.constraints().impose(u);
    for (const ContactNode<dim> &node : d.contact())
      move_out_of_obstacle(node, u);
    return u;
  }



  /** The largest difference of two displacements, in parts of the largest
   * component of the second one. Collective. */
  inline double
  relative_distance(const VectorType &u, const VectorType &v)
  {
    VectorType difference(u);
    difference -= v;
    return difference.linfty_norm() / v.linfty_norm();
  }



  /** Whether the same nodes of this process are in contact, and stick. */
  inline bool
  phases_agree(const ContactState &a, const ContactState &b)
  {
    if (a.size() != b.size())
      return false;
    for (unsigned int p = 0; p < a.size(); ++p)
      if (a.in_contact(p) != b.in_contact(p) || a.sticks(p) != b.sticks(p))
        return false;
    return true;
  }



  /** The largest difference of two sets of normal forces, in parts of the
   * largest one of both. Collective. */
  inline double
  relative_distance_of_forces(const ContactState &a, const ContactState &b)
  {
    double largest = 0., worst = 0.;
    for (unsigned int p = 0; p < a.size(); ++p)
      {
        largest = std::max({largest, a.normal_force(p), b.normal_force(p)});
        worst =
          std::max(worst, std::abs(a.normal_force(p) - b.normal_force(p)));
      }
    worst   = Utilities::MPI::max(worst, MPI_COMM_WORLD);
    largest = Utilities::MPI::max(largest, MPI_COMM_WORLD);
    return largest > 0. ? worst / largest : 0.;
  }



  /** The points of all nodes of this process, by node number. */
  template <int dim>
  std::vector<Point<dim>>
  node_points(const Discretization<dim> &d)
  {
    std::vector<Point<dim>> points(d.constraints().n_nodes());
    for (const auto &cell : d.dof_handler().active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int v : cell->vertex_indices())
          points[d.constraints().node_of_dof(cell->vertex_dof_index(v, 0))] =
            cell->vertex(v);
    return points;
  }



  /** A single sweep of the leading relaxation. */
  template <int dim>
  void
  sweep(const MonotoneSmoother<dim> &smoother,
        VectorType                  &u,
        ContactState                &state,
        const bool                   updates_normal_forces)
  {
    Iterate x(u, state, updates_normal_forces);
    smoother.relax(x, 1);
  }



  /** The settings for a test that wants to see the first attempt fail: what it
   * tests must not be rescued by something else. */
  inline SolverSettings
  without_safeguards(SolverSettings settings)
  {
    settings.safeguards = false;
    return settings;
  }

  /** A scene, likewise. */
  inline Parameters
  without_safeguards(Parameters parameters)
  {
    parameters.solver.safeguards = false;
    return parameters;
  }
} // namespace Tests

#endif
