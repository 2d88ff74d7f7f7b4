// The nodes of the possible contact boundary: normals, frames, gaps, measures,
// and input that makes no sense.
//
// On the half disc the normal is known, n(p) = p/|p|, and so is the gap along
// it to the plane y=-1: (1+y)/(-n_y). The measures are integrals of the nodal
// functions over the boundary: they sum up to its length or area wherever all
// of its nodes may touch. In three dimensions nodes hang on the contact
// boundary; they carry nothing, and what is theirs belongs to their masters,
// exactly as when the functions are condensed.

#include <common/discretization/contact_boundary.h>
#include <common/parameters/wrong_number.h>

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_values.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_contact_boundary
{
  Parameters
  half_disc()
  {
    Parameters p;
    p.scene.geometry       = GeometryKind::half_disc;
    p.scene.radius         = 1.;
    p.obstacle.kind        = ObstacleKind::plane;
    p.obstacle.point       = {0., -1.};
    p.obstacle.normal      = {0., -1.};
    p.contact.boundary     = "0";
    p.contact.friction_law = FrictionLaw::none;
    p.contact.normal       = ContactNormal::body;
    p.boundary_conditions.displacement.push_back({"1", {"0", "-0.0062"}});
    return p;
  }



  template <int dim>
  double
  frame_error(const ContactBoundary<dim> &contact)
  {
    double error = 0;
    for (const ContactNode<dim> &p : contact)
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = 0; b < dim; ++b)
          error = std::max(
            error, std::abs(p.frame[a] * p.frame[b] - (a == b ? 1. : 0.)));
    return error;
  }



  void
  test_half_disc()
  {
    Random                 random(1);
    const RandomProblem<2> problem(half_disc(), 3, .5, random);
    double                 normals = 0, gaps = 0, on_arc = 0;
    for (const ContactNode<2> &p : problem.contact())
      {
        const Tensor<1, 2> radial = Tensor<1, 2>(p.point) / p.point.norm();
        normals = std::max(normals, (p.normal() - radial).norm());
        gaps = std::max(gaps, std::abs(p.gap * -radial[1] - (1. + p.point[1])));
        on_arc = std::max(on_arc, std::abs(p.point.norm() - 1.));
      }
    std::cout << "half disc, " << problem.contact().size() << " contact nodes"
              << std::endl;
    check_below(normals, 1e-14, "normals are radial");
    check_below(gaps, 1e-14, "gaps along the normal");
    check_below(on_arc, 1e-14, "the nodes are on the arc");
    check_below(frame_error(problem.contact()), 1e-14, "frames");

    // What looks past the obstacle is left out, and nothing else.
    bool              left_out = true;
    unsigned int      n_arc    = 0;
    std::vector<char> listed(problem.constraints().n_nodes(), 0);
    for (const ContactNode<2> &p : problem.contact())
      listed[p.node] = 1;
    for (const auto &cell :
         problem.discretization.dof_handler().active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        {
          const Point<2> x = cell->vertex(v);
          if (std::abs(x.norm() - 1.) > 1e-10)
            continue;
          ++n_arc;
          left_out = left_out &&
            listed[problem.constraints().node_of_dof(
              cell->vertex_dof_index(v, 0))] == (-x[1] > .05);
        }
    check(left_out && n_arc > 2 * problem.contact().size(),
          "listed are the nodes whose normal meets the obstacle");

    // The other normal: from the node straight to a disc below.
    Parameters parameters       = half_disc();
    parameters.contact.normal   = ContactNormal::obstacle;
    parameters.obstacle.kind    = ObstacleKind::rods;
    parameters.obstacle.centers = {{.3, -2.5}};
    parameters.obstacle.radii   = {1.};
    const RandomProblem<2> other(parameters, 2, .5, random);
    normals = gaps = 0;
    for (const ContactNode<2> &p : other.contact())
      {
        const Tensor<1, 2> to_centre = Point<2>(.3, -2.5) - p.point;
        normals =
          std::max(normals, (p.normal() - to_centre / to_centre.norm()).norm());
        gaps = std::max(gaps, std::abs(p.gap - (to_centre.norm() - 1.)));
      }
    check(other.contact().size() > 0, "an obstacle with its own normals");
    check_below(normals, 1e-14, "normals of the obstacle");
    check_below(gaps, 1e-14, "gaps along normals of the obstacle");
  }



  // A flat boundary above a rod that crosses it: normals straight towards the
  // axis of the rod. That they differ from the boundary's own does not change
  // the measures.
  void
  test_rod()
  {
    Random                 random(3);
    const RandomProblem<3> problem(
      curved_parameters<3>(FrictionLaw::none, 0.), 3, .3, random);
    const Tensor<1, 3> axis    = Point<3>(1., 2., 0.) / std::sqrt(5.);
    double             normals = 0, gaps = 0, flattest = 1., area = 0;
    for (const ContactNode<3> &p : problem.contact())
      {
        Tensor<1, 3> to_axis = Point<3>(.75, .5, -3.) - p.point;
        to_axis -= (to_axis * axis) * axis;
        normals =
          std::max(normals, (p.normal() - to_axis / to_axis.norm()).norm());
        gaps     = std::max(gaps, std::abs(p.gap - (to_axis.norm() - 3.)));
        flattest = std::min(flattest, -p.normal()[2]);
        area += p.measure;
      }
    const unsigned int n_hanging =
      problem.n_hanging_at_contact([](const unsigned int) { return true; });
    std::cout << "rod, " << problem.contact().size() << " contact nodes, "
              << n_hanging << " hanging nodes on the contact boundary"
              << std::endl;
    check(n_hanging > 0, "nodes hang there");
    check(flattest < .99, "normals in all directions");
    check_below(normals, 1e-14, "normals towards the axis");
    check_below(gaps, 1e-14, "gaps along the normal");
    check_below(frame_error(problem.contact()), 1e-14, "frames");
    check_below(
      std::abs(area - 1.5), 1e-13, "measures sum up to the boundary's");
  }



  // Measures on the bottom of a block, compared with the integrals of the
  // condensed nodal functions.
  template <int dim>
  void
  test_measures(const unsigned int n_rounds, const double density)
  {
    Random                   random(3);
    const RandomProblem<dim> problem(
      block_parameters<dim>(FrictionLaw::none, 0.), n_rounds, density, random);
    const auto &disc        = problem.discretization;
    const auto &constraints = problem.constraints();

    VectorType            integrals(disc.dof_handler().locally_owned_dofs(),
                         MPI_COMM_WORLD);
    const QGauss<dim - 1> quadrature(3);
    FEFaceValues<dim>     face_values(disc.mapping(),
                                  disc.dof_handler().get_fe(),
                                  quadrature,
                                  update_values | update_JxW_values);
    Vector<double>        local(disc.dof_handler().get_fe().n_dofs_per_cell());
    std::vector<types::global_dof_index> indices(local.size());
    std::vector<char> hangs_at_contact(constraints.n_nodes(), 0);
    for (const auto &cell : disc.dof_handler().active_cell_iterators())
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary() &&
            cell->face(f)->boundary_id() ==
              problem.scene.contact_conditions()[0].boundary_id)
          {
            face_values.reinit(cell, f);
            local = 0.;
            for (const unsigned int q : face_values.quadrature_point_indices())
              for (unsigned int i = 0; i < local.size(); ++i)
                local(i) += face_values.shape_value(i, q) * face_values.JxW(q);
            cell->get_dof_indices(indices);
            disc.hanging_nodes().distribute_local_to_global(
              local, indices, integrals);
            for (unsigned int v = 0; v < cell->face(f)->n_vertices(); ++v)
              {
                const unsigned int node = constraints.node_of_dof(
                  cell->face(f)->vertex_dof_index(v, 0));
                if (constraints.is_hanging(node))
                  hangs_at_contact[node] = 1;
              }
          }
    integrals.compress(VectorOperation::add);

    unsigned int n_hanging = 0;
    for (const char hangs : hangs_at_contact)
      n_hanging += hangs;
    std::cout << dim << "D block, " << problem.contact().size()
              << " contact nodes, " << n_hanging
              << " hanging nodes on the contact boundary" << std::endl;

    check((n_hanging > 0) == (dim == 3),
          "nodes hang there in 3D, and not in 2D");

    double sum = 0, difference = 0, gaps = 0;
    bool   none_hangs = true, smallest = true;
    for (const ContactNode<dim> &p : problem.contact())
      {
        sum += p.measure;
        difference =
          std::max(difference,
                   std::abs(p.measure - integrals.local_element(dim * p.node)));
        gaps       = std::max(gaps, std::abs(p.gap));
        none_hangs = none_hangs && !constraints.is_hanging(p.node);
        smallest   = smallest && p.measure > 0;
      }
    check_below(
      std::abs(sum - 1.5), 1e-13, "measures sum up to the boundary's");
    check_below(difference, 1e-14, "measures are those of condensed functions");
    check(none_hangs && smallest, "no hanging node, no node without measure");
    check_below(gaps, 1e-14, "nodes on the obstacle have no gap");
    check_below(frame_error(problem.contact()), 1e-14, "frames");
  }



  // Dirichlet nodes at the rim of the contact boundary.
  template <int dim>
  void
  test_rim(const std::vector<std::string> &left, const std::string &what)
  {
    Parameters parameters = block_parameters<dim>(FrictionLaw::none, 0.);
    parameters.boundary_conditions.displacement.push_back({"0", left});
    Random random(3);
    try
      {
        const RandomProblem<dim> problem(parameters, 2, .5, random);
        unsigned int             n_full = 0, n_fewer = 0, n_at_rim = 0;
        bool                     last = true;
        for (const ContactNode<dim> &p : problem.contact())
          {
            n_at_rim += std::abs(p.point[0]) < 1e-12;
            if (p.n_free_tangents == dim - 1)
              ++n_full;
            else
              {
                ++n_fewer;
                // What is prescribed comes last in the frame.
                last =
                  last && std::abs(std::abs(p.frame[dim - 1][0]) - 1.) < 1e-14;
              }
          }
        check(n_full > 0 && last && n_fewer == n_at_rim,
              what + ": " + std::to_string(n_fewer > 0) +
                " with one tangent less, " + std::to_string(n_at_rim > 0) +
                " at the rim");
      }
    catch (const InputError &error)
      {
        const std::string text = error.what();
        std::cout << "error   " << what << ": "
                  << (text.find("into the obstacle") != std::string::npos
                        ? "penetrates"
                        : text.find("competes") != std::string::npos
                        ? "competes"
                        : text)
                  << std::endl;
      }
  }
} // namespace test_contact_boundary

TEST(contact_boundary)
{
  test_half_disc();
  test_rod();
  test_measures<2>(3, .5);
  test_measures<3>(3, .3);

  test_rim<2>({"0", "0"}, "2D, held at the obstacle");
  test_rim<2>({"0", "-0.01"}, "2D, pushed into the obstacle");
  test_rim<2>({"free", "-0.01"}, "2D, normal component prescribed");
  test_rim<2>({"0", "free"}, "2D, tangential component prescribed");
  test_rim<3>({"0", "0", "-0.01"}, "3D, pushed into the obstacle");
  test_rim<3>({"free", "free", "0"}, "3D, normal component prescribed");
  test_rim<3>({"0", "free", "free"}, "3D, tangential component prescribed");
}
