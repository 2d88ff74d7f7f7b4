// A coefficient of friction that is not the same everywhere: a patch test where
// it jumps, with a closed form that finite elements solve to rounding; and an
// expression that has the same value everywhere, with which nothing may differ
// from that number.

#include <common/algorithms/nested_iteration.h>

#include <deal.II/grid/grid_tools.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_varying_friction
{
  // Copies of a mesh side by side as one mesh, boundary ids included.
  template <int dim>
  void
  make_copies(const Triangulation<dim> &one,
              const Tensor<1, dim>     &distance,
              const unsigned int        n,
              Triangulation<dim>       &all)
  {
    std::vector<Point<dim>>    vertices;
    std::vector<CellData<dim>> cells;
    SubCellData                boundary;
    for (unsigned int copy = 0; copy < n; ++copy)
      {
        auto [points, their_cells, faces] =
          GridTools::get_coarse_mesh_description(one);
        const unsigned int first = vertices.size();
        for (const Point<dim> &p : points)
          vertices.push_back(p + copy * distance);
        const auto append = [first](auto &from, auto &to) {
          for (auto &item : from)
            {
              for (auto &vertex : item.vertices)
                vertex += first;
              to.push_back(item);
            }
        };
        append(their_cells, cells);
        append(faces.boundary_lines, boundary.boundary_lines);
        append(faces.boundary_quads, boundary.boundary_quads);
      }
    all.create_triangulation(vertices, cells, boundary);
  }



  // The blocks of the scene stick-slip side by side, each with a coefficient of
  // its own, so that the first one sticks, the second one slips, and the third
  // one is free of friction. The scene's expressions use F, and with it they
  // are those of each block.
  template <int dim>
  void
  three_blocks(const std::string &scene_file, const double angle)
  {
    const double       spacing = 3;
    std::ostringstream rotation;
    rotation << "Scene/Rotation angle=" << angle;
    const Parameters   parameters = without_safeguards(read_parameters(
      scene_file,
      {"Contact/Friction coefficient=if(x < 2.5, 0.8, if(x < 5.5, 0.4, 0))",
         rotation.str(),
         "Solver/Inner tolerance=1e-13"}));
    const Scene<dim>   scene(parameters);
    Triangulation<dim> block;
    scene.make_coarse_mesh(block);
    Tensor<1, dim> distance;
    distance[0] = spacing * std::cos(angle * numbers::PI / 180.);
    distance[1] = spacing * std::sin(angle * numbers::PI / 180.);
    auto mesh   = make_triangulation<dim>();
    make_copies(block, distance, 3, *mesh);
    mesh->refine_global(1);
    unsigned int n = 0;
    for (const auto &cell : mesh->active_cell_iterators())
      if (n++ % 7 == 3)
        cell->set_refine_flag();
    mesh->execute_coarsening_and_refinement();

    const Discretized<dim>      d(scene, *mesh);
    const ContactBoundary<dim> &contact = d.contact();
    VectorType                  u       = admissible_start(d);
    ContactState                state(contact.size(), true);
    ContactSolver<dim> solver(d, without_safeguards(parameters.solver));
    const SolverReport report = solver.solve(u, state);
    d.hanging_nodes().distribute(u);

    double         error = 0, scale = 0;
    const auto     points = node_points(d);
    Vector<double> exact(dim);
    for (unsigned int i = 0; i < points.size(); ++i)
      {
        scene.exact_displacement()->vector_value(points[i], exact);
        for (unsigned int c = 0; c < dim; ++c)
          error =
            std::max(error, std::abs(u.local_element(dim * i + c) - exact[c]));
        scale = std::max(scale, exact.l2_norm());
      }

    // The drag of each node is that of its own block.
    const double lambda = parameters.material.lambda(),
                 mu = parameters.material.mu(), p = (lambda + 2 * mu) * .02;
    const std::array<double, 3> drags = {{mu * .04, .4 * p, 0.}};
    std::array<unsigned int, 3> n_nodes{}, n_sticking{};
    double                      drag_error = 0;
    for (unsigned int i = 0; i < contact.size(); ++i)
      {
        const double x =
          contact[i].point * distance / distance.norm() / spacing;
        const unsigned int b      = x < .8 ? 0 : x < 1.8 ? 1 : 2;
        double             square = 0;
        for (const double r :
             tangential_components<dim>(contact[i], report.residual))
          square += r * r;
        drag_error =
          std::max(drag_error,
                   std::abs(std::sqrt(square) / contact[i].measure - drags[b]));
        ++n_nodes[b];
        n_sticking[b] += state.sticks(i);
      }
    std::ostringstream what;
    what << dim << "D, turned by " << angle << " degrees: ";
    check(contact.largest_coefficient() == .8 && report.converged &&
            state.n_contact() == contact.size(),
          what.str() + "all nodes in contact");
    check(n_sticking[0] == n_nodes[0] && n_sticking[1] == 0 &&
            n_sticking[2] == 0,
          what.str() + "the first block sticks, the others slip");
    check(error < 1e-10 * scale && drag_error < 1e-10 * p,
          what.str() + "displacements and stresses to 1e-10");
    check(report.certificate.largest() < 1e-9, what.str() + "certified");
    if (!(error < 1e-10 * scale && drag_error < 1e-10 * p))
      std::cout << "  " << error / scale << ' ' << drag_error / p << std::endl;
  }



  // To the last bit, for this is what it costs nothing for.
  template <int dim>
  void
  constant(const std::string &scene_file, const std::string &number)
  {
    const auto run = [&](const std::string &text) {
      auto iteration = std::make_unique<NestedIteration<dim>>(read_parameters(
        scene_file,
        {"Contact/Friction coefficient=" + text, "Refinement/Levels=2"}));
      iteration->begin();
      do
        iteration->solve();
      while (iteration->advance());
      return iteration;
    };
    const auto one = run(number), other = run(number + " + 0*x");
    VectorType difference = one->displacement();
    check(one->report().cycles.size() == other->report().cycles.size() &&
            one->state().n_sticking() == other->state().n_sticking() &&
            one->estimate().total == other->estimate().total &&
            difference.size() == other->displacement().size(),
          number + " as an expression: the same meshes, phases and estimate");
    difference -= other->displacement();
    check(difference.linfty_norm() == 0.,
          number + " as an expression: the same displacement");
  }
} // namespace test_varying_friction

TEST(varying_friction)
{
  three_blocks<2>(SCENES_DIR "/stick-slip.prm", 0.);
  three_blocks<2>(SCENES_DIR "/stick-slip.prm", 25.);
  three_blocks<3>(SCENES_3D_DIR "/stick-slip.prm", 25.);
  constant<2>(SCENES_DIR "/hertz.prm", "0.4");
}
