// Cells between straight sides and a sphere: means of points of a cell against
// the formula of its places, and the half ball against the one that deal.II
// makes.

#include <common/scene/round_manifolds.h>
#include <common/scene/scene.h>
#include <common/scene/shell_manifold.h>

#include <deal.II/grid/manifold_lib.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include <tests/support/check.h>
#include <tests/support/means_in_cell.h>
#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;
using namespace Tests;

namespace test_shell_manifold
{
  using Side = std::array<Tensor<1, 3>, 4>;

  // One coarse cell between a straight side and a sphere; or the mesh of one
  // whose coordinate r is the first.
  void
  make_cell(const Side       &side,
            const double      radius,
            const bool        r_is_first,
            Triangulation<3> &mesh)
  {
    std::vector<Point<3>>    vertices;
    std::vector<CellData<3>> cells(1);
    for (const Tensor<1, 3> &p : side)
      vertices.emplace_back(p);
    for (const Tensor<1, 3> &p : side)
      vertices.emplace_back(radius / p.norm() * p);
    if (r_is_first)
      cells[0].vertices = {0, 4, 1, 5, 2, 6, 3, 7};
    else
      cells[0].vertices = {0, 1, 2, 3, 4, 5, 6, 7};
    mesh.create_triangulation(vertices, cells, SubCellData());
    const auto cell = mesh.begin_active();
    cell->set_manifold_id(1);
    cell->face(r_is_first ? 1 : 5)->set_manifold_id(0);
  }



  // A new point is where the weighted mean of others is, in the coordinates of
  // the cell.
  double
  error_in_cell(const Side &side, const double radius, const bool r_is_first)
  {
    Triangulation<3> mesh;
    make_cell(side, radius, r_is_first, mesh);
    const ShellManifold manifold(mesh, 1, 0);
    const auto          x = [&](const Point<3> &place) {
      Tensor<1, 3> c;
      for (unsigned int v = 0; v < 4; ++v)
        c += (v % 2 == 0 ? 1. - place[0] : place[0]) *
          (v / 2 == 0 ? 1. - place[1] : place[1]) * side[v];
      const double r = place[2];
      return Point<3>(((1. - r) * c.norm() + r * radius) / c.norm() * c);
    };

    return error_of_means(manifold, x) / radius;
  }



  void
  means_in_cells()
  {
    const auto direction = [](const double x, const double y, const double z) {
      return Tensor<1, 3>({x, y, z});
    };
    // A quarter of a side of a cube, whose coordinates s, t and r are a right
    // hand; the same in the other order; one whose corners are not in a plane;
    // one that is nearly a triangle.
    const Side flat   = {{direction(0., 0., -.5),
                          direction(0., .5, -.5),
                          direction(.5, 0., -.5),
                          direction(.5, .5, -.5)}},
               left   = {{flat[0], flat[2], flat[1], flat[3]}},
               bent   = {{direction(.1, -.1, -.7),
                          direction(.4, 0., -.3),
                          direction(0., .5, -.6),
                          direction(.5, .4, -.2)}},
               narrow = {{direction(-.3, 0., -.5),
                          direction(.3, 0., -.5),
                          direction(-.01, .4, -.5),
                          direction(.01, .4, -.5)}};
    for (const bool r_is_first : {false, true})
      {
        const auto check =
          [&](const Side &side, const double limit, const std::string &what) {
            check_below(error_in_cell(side, 1., r_is_first), limit, what);
          };
        check(flat, 1e-14, "means of points of a cell");
        check(left, 1e-14, "the same, with a left hand");
        check(bent, 1e-14, "the same, with a bent side");
        check(narrow, 1e-13, "the same, with a narrow one");
      }
    Side small = bent;
    for (Tensor<1, 3> &p : small)
      p *= 1e-30;
    check_below(error_in_cell(small, 1e-30, false),
                1e-14,
                "the same, where all is small");
  }



  // Two refinements: vertices on the straight sides and edges of coarse cells
  // and on the sphere are where deal.II has them; others are not far from
  // there, in parts of the radius. Cells are an eighth long.
  void
  half_ball(const std::string &angle)
  {
    std::ofstream("scene.prm") << "subsection Boundary conditions\n  set "
                                  "Displacement = 1: 0, 0, 0\nend\n";
    const double     R = 2.;
    const Scene<3>   scene(read_parameters("scene.prm",
                                         {"Scene/Geometry=half ball",
                                            "Scene/Radius=2",
                                            "Scene/Rotation angle=" + angle}));
    Triangulation<3> mesh, expected;
    scene.make_coarse_mesh(mesh);
    scene.make_coarse_mesh(expected);
    expected.set_manifold(0, SphericalManifold<3>());
    TransfiniteInterpolationManifold<3> by_deal_II;
    by_deal_II.initialize(expected);
    expected.set_manifold(1, by_deal_II);

    // Edges of the shell towards the origin, by their ends.
    std::vector<std::array<Point<3>, 2>> edges;
    for (const auto &cell : mesh.cell_iterators_on_level(0))
      for (unsigned int l = 0; l < 12; ++l)
        {
          const auto line = cell->line(l);
          if (line->manifold_id() == 1)
            edges.push_back({{line->vertex(0), line->vertex(1)}});
        }
    const auto is_on_edge = [&](const Point<3> &p) {
      return std::any_of(edges.begin(), edges.end(), [&](const auto &ends) {
        return std::abs(p.distance(ends[0]) + p.distance(ends[1]) -
                        ends[0].distance(ends[1])) < 1e-12;
      });
    };

    for (Triangulation<3> *triangulation : {&mesh, &expected})
      triangulation->refine_global(2);
    std::set<unsigned int> straight, round;
    for (const auto &cell : mesh.active_cell_iterators())
      {
        if (cell->manifold_id() == numbers::flat_manifold_id)
          for (const unsigned int v : cell->vertex_indices())
            straight.insert(cell->vertex_index(v));
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && face->boundary_id() == 0)
            for (const unsigned int v : face->vertex_indices())
              round.insert(face->vertex_index(v));
      }
    enum
    {
      on_core,
      on_sphere,
      on_edges,
      inside
    };
    std::array<double, 4>       off = {};
    std::array<unsigned int, 4> n   = {};
    for (unsigned int v = 0; v < mesh.n_vertices(); ++v)
      {
        const Point<3>     p    = mesh.get_vertices()[v];
        const unsigned int kind = (straight.count(v) > 0  ? on_core
                                     : round.count(v) > 0 ? on_sphere
                                     : is_on_edge(p)      ? on_edges
                                                          : inside);
        ++n[kind];
        off[kind] =
          std::max(off[kind], p.distance(expected.get_vertices()[v]) / R);
      }
    std::cout << mesh.n_active_cells() << " cells, found by us "
              << (dynamic_cast<const ShellManifold *>(&mesh.get_manifold(1)) !=
                  nullptr)
              << "; vertices in the core " << n[on_core] << ", on the sphere "
              << n[on_sphere] << ", on edges " << n[on_edges] << ", inside "
              << n[inside] << std::endl;
    check_below(off[on_core], 1e-9, "those in the core");
    check_below(off[on_sphere], 1e-9, "those on the sphere");
    check_below(off[on_edges], 1e-9, "those on edges");
    check_below(off[inside], .01, "those inside");
  }
} // namespace test_shell_manifold



TEST(shell_manifold)
{
  test_shell_manifold::means_in_cells();
  test_shell_manifold::half_ball("0");
  test_shell_manifold::half_ball("20");
}
