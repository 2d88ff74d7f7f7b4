// The meshes of a scene: the half disc in numbers, its symmetry, its shape
// after refinement; small discs and half balls; cells between straight sides
// and a circle, in the plane and along a cylinder, against their formula and
// against those that deal.II finds; distortion and rotation of a rectangle; a
// mesh from a file.

#include <common/scene/extruded_manifold.h>
#include <common/scene/ring_manifold.h>
#include <common/scene/scene.h>

#include <deal.II/base/mpi.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/grid/grid_out.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <array>
#include <fstream>
#include <iostream>
#include <set>
#include <type_traits>

#include <tests/support/check.h>
#include <tests/support/means_in_cell.h>
#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;
using namespace Tests;

namespace test_geometry
{
  Parameters
  parameters(const std::vector<std::string> &overrides)
  {
    std::ofstream("scene.prm")
      << "subsection Boundary conditions\n  set Displacement = 1: 0, 0\nend\n";
    return read_parameters("scene.prm", overrides);
  }



  // Smallest and largest angle, in degrees, of all cells.
  std::pair<double, double>
  angles(const Triangulation<2> &triangulation)
  {
    std::pair<double, double> range(180., 0.);
    const unsigned int        around[4] = {0, 1, 3, 2};
    for (const auto &cell : triangulation.active_cell_iterators())
      for (unsigned int i = 0; i < 4; ++i)
        {
          const Point<2>     p = cell->vertex(around[i]);
          const Tensor<1, 2> a = cell->vertex(around[(i + 1) % 4]) - p;
          const Tensor<1, 2> b = cell->vertex(around[(i + 3) % 4]) - p;
          const double       angle =
            std::acos(a * b / (a.norm() * b.norm())) * 180. / numbers::PI;
          range.first  = std::min(range.first, angle);
          range.second = std::max(range.second, angle);
        }
    return range;
  }



  void
  half_disc()
  {
    const Scene<2> scene(
      parameters({"Scene/Geometry=half disc", "Scene/Radius=2"}));
    parallel::distributed::Triangulation<2> mesh(
      MPI_COMM_WORLD,
      Triangulation<2>::limit_level_difference_at_vertices,
      parallel::distributed::Triangulation<2>::construct_multigrid_hierarchy);
    scene.make_coarse_mesh(mesh);

    for (unsigned int level = 0; level < 6; ++level)
      {
        unsigned int n_arc = 0, n_flat = 0;
        double       off_arc = 0., off_flat = 0.;
        for (const auto &cell : mesh.active_cell_iterators())
          for (const auto &face : cell->face_iterators())
            if (face->at_boundary())
              {
                ++(face->boundary_id() == 0 ? n_arc : n_flat);
                for (unsigned int v = 0; v < 2; ++v)
                  if (face->boundary_id() == 0)
                    off_arc =
                      std::max(off_arc, std::abs(face->vertex(v).norm() - 2.));
                  else
                    off_flat = std::max(off_flat, std::abs(face->vertex(v)[1]));
              }

        // Vertices in a grid much finer than the mesh, to find mirror images.
        std::set<std::pair<long, long>> places;
        const auto place = [](const double x) { return std::lround(x * 1e7); };
        for (const Point<2> &v : mesh.get_vertices())
          places.insert({place(v[0]), place(v[1])});
        unsigned int n_lonely = 0;
        for (const Point<2> &v : mesh.get_vertices())
          {
            bool found = false;
            for (int i = -1; i <= 1; ++i)
              for (int j = -1; j <= 1; ++j)
                found = found ||
                  places.count({place(-v[0]) + i, place(v[1]) + j}) > 0;
            if (!found)
              ++n_lonely;
          }

        const auto range = angles(mesh);
        std::cout << mesh.n_active_cells() << " cells "
                  << mesh.n_used_vertices() << " vertices " << n_arc << " arc "
                  << n_flat << " flat, off arc " << (off_arc > 1e-14)
                  << ", off flat " << (off_flat > 1e-14) << ", not mirrored "
                  << n_lonely << ", angles " << std::lround(range.first) << ' '
                  << std::lround(range.second) << std::endl;
        if (level < 5)
          mesh.refine_global();
      }
  }



  // Refine the cells around the lowest point of a round body, unless there are
  // far more of them than there can be.
  template <int dim>
  void
  refine_lowest_point(Triangulation<dim> &mesh,
                      const double        radius,
                      const unsigned int  n_times)
  {
    Point<dim> lowest;
    lowest[dim - 1] = -radius;
    for (unsigned int i = 0; i < n_times && mesh.n_active_cells() < 1000; ++i)
      {
        for (const auto &cell : mesh.active_cell_iterators())
          for (const unsigned int v : cell->vertex_indices())
            if (cell->vertex(v).distance(lowest) < 1e-12 * radius)
              cell->set_refine_flag();
        mesh.execute_coarsening_and_refinement();
      }
  }



  // A small disc, refined 25 times at its lowest point: chords of the arc have
  // the length that their level says.
  void
  small_disc()
  {
    const double   R = 1e-12;
    const Scene<2> scene(
      parameters({"Scene/Geometry=half disc", "Scene/Radius=1e-12"}));
    Triangulation<2> mesh;
    scene.make_coarse_mesh(mesh);
    refine_lowest_point(mesh, R, 25);
    double worst = 0.;
    for (const auto &cell : mesh.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && face->boundary_id() == 0)
          {
            const double half_angle =
              numbers::PI / 24. / std::pow(2., cell->level());
            const double chord  = 2. * R * std::sin(half_angle);
            const double length = face->vertex(0).distance(face->vertex(1));
            worst = std::max(worst, std::abs(length / chord - 1.));
          }
    std::cout << mesh.n_levels() << " levels, " << mesh.n_active_cells()
              << " cells" << std::endl;
    check_below(worst, 1e-6, "chords of a small disc");
  }



  // The same with a half ball, whose edges differ from each other. Those of the
  // finest cells, which are around the lowest point, are as long as those of a
  // ball of radius one are after a few refinements, to the curvature.
  void
  small_half_ball()
  {
    const auto shortest_and_longest = [](const std::string &radius,
                                         const unsigned int n_refinements) {
      const double     R = std::stod(radius);
      const Scene<3>   scene(parameters({"Scene/Geometry=half ball",
                                         "Scene/Radius=" + radius,
                                         "Boundary conditions/Displacement="
                                           "1: 0, 0, 0"}));
      Triangulation<3> mesh;
      scene.make_coarse_mesh(mesh);
      refine_lowest_point(mesh, R, n_refinements);
      std::pair<double, double> range(R, 0.);
      double                    off = 0.;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->level() + 1U == mesh.n_levels())
          for (const auto &face : cell->face_iterators())
            if (face->at_boundary() && face->boundary_id() == 0)
              for (unsigned int l = 0; l < 4; ++l)
                {
                  const double length =
                    face->line(l)->vertex(0).distance(face->line(l)->vertex(1));
                  range.first  = std::min(range.first, length);
                  range.second = std::max(range.second, length);
                  off =
                    std::max(off, std::abs(face->vertex(l).norm() / R - 1.));
                }
      std::cout << mesh.n_levels() << " levels, " << mesh.n_active_cells()
                << " cells, off sphere " << (off > 1e-14) << std::endl;
      const double unit = R / std::pow(2., mesh.n_levels());
      return std::make_pair(range.first / unit, range.second / unit);
    };
    const auto large = shortest_and_longest("1", 10);
    const auto small = shortest_and_longest("1e-12", 20);
    check_below(std::max(std::abs(small.first / large.first - 1.),
                         std::abs(small.second / large.second - 1.)),
                1e-3,
                "edges of a small half ball");
  }



  // Cells of the ring have manifold id 1. Cells are refined everywhere, and
  // then every third one, so that there are all kinds of faces. In a coarse
  // cell deal.II's iterations end at 3e-11 of its diameter, in space and in the
  // section; the middle of a cell in space is a mean of 26 points, whose
  // weights have the sum of moduli 7, and errors of the levels add.
  template <int dim>
  void
  ring(std::vector<std::string> overrides)
  {
    if (dim == 3)
      overrides.push_back("Boundary conditions/Displacement=1: 0, 0, 0");
    const Scene<dim>   scene(parameters(overrides));
    Triangulation<dim> mesh, expected;
    scene.make_coarse_mesh(mesh);
    scene.make_coarse_mesh(expected);
    if (dim == 2)
      expected.set_manifold(0, SphericalManifold<dim>());
    TransfiniteInterpolationManifold<dim> by_deal_II;
    by_deal_II.initialize(expected);
    expected.set_manifold(1, by_deal_II);

    for (Triangulation<dim> *triangulation : {&mesh, &expected})
      {
        triangulation->refine_global();
        unsigned int n = 0;
        for (const auto &cell : triangulation->active_cell_iterators())
          if (++n % 3 == 0)
            cell->set_refine_flag();
        triangulation->execute_coarsening_and_refinement();
      }
    bool is_same = mesh.n_vertices() == expected.n_vertices();
    for (unsigned int v = 0; v < mesh.n_vertices() && is_same; ++v)
      is_same =
        mesh.get_vertices()[v].distance(expected.get_vertices()[v]) < 1e-9;
    using Ours = std::conditional_t<dim == 2, RingManifold, ExtrudedManifold>;
    const bool is_ours =
      dynamic_cast<const Ours *>(&mesh.get_manifold(1)) != nullptr;
    std::cout << mesh.n_active_cells() << " cells, found by us " << is_ours
              << ", vertices where deal.II has them " << is_same << std::endl;
  }



  // Points of a cell of the ring by their coordinates in it. The cell, between
  // the side `inner` and the arc of these degrees, is x(s,t) = (1-t) inner(s) +
  // t circle(s); a new point is where the weighted mean of others is.
  void
  means_in_cell(const Manifold<2>             &manifold,
                const std::array<Point<2>, 2> &inner,
                const std::array<double, 2>   &degrees,
                const std::string             &what)
  {
    const auto x = [&](const Point<2> &place) {
      const double s = place[0], t = place[1];
      const double angle =
        (degrees[0] + s * (degrees[1] - degrees[0])) * numbers::PI / 180.;
      return (1. - t) * (inner[0] + s * (inner[1] - inner[0])) +
        t * Point<2>(std::cos(angle), std::sin(angle));
    };
    check_below(error_of_means(manifold, x), 1e-14, what);
  }



  // The first of the cells of the half disc, and one that leans to one side:
  // there the place of a point is not the only root of its equation.
  void
  ring_cells()
  {
    const Scene<2>   scene(parameters({"Scene/Geometry=half disc"}));
    Triangulation<2> disc;
    scene.make_coarse_mesh(disc);
    means_in_cell(disc.get_manifold(1),
                  {{Point<2>(-.681, 0.), Point<2>(-.659, -.214)}},
                  {{180., 195.}},
                  "means of points of a ring cell");

    const std::array<Point<2>, 2> inner = {
      {Point<2>(.8, 0.), Point<2>(.2, .4)}};
    std::vector<CellData<2>> cells(1);
    cells[0].vertices = {0, 1, 2, 3};
    Triangulation<2> mesh;
    mesh.create_triangulation(
      {inner[0], Point<2>(1., 0.), inner[1], Point<2>(.5, std::sqrt(.75))},
      cells,
      SubCellData());
    const auto cell = mesh.begin_active();
    cell->set_manifold_id(1);
    cell->face(1)->set_manifold_id(0);
    means_in_cell(
      RingManifold(mesh, 1, 0), inner, {{0., 60.}}, "the same where it leans");
  }



  template <int dim>
  void
  print(const std::vector<std::string> &overrides)
  {
    const Scene<dim>   scene(parameters(overrides));
    Triangulation<dim> mesh;
    scene.make_coarse_mesh(mesh);
    std::cout << mesh.n_active_cells() << " cells, volume "
              << GridTools::volume(mesh) << ", ids";
    for (const auto id : mesh.get_boundary_ids())
      std::cout << ' ' << id;
    std::cout << std::endl;
    if (dim == 2)
      for (const Point<dim> &vertex : mesh.get_vertices())
        std::cout << "  " << vertex << std::endl;
  }



  template <int dim>
  void
  check(const std::vector<std::string> &overrides)
  {
    try
      {
        const Scene<dim>   scene(parameters(overrides));
        Triangulation<dim> mesh;
        scene.make_coarse_mesh(mesh);
        std::cout << "accepted" << std::endl;
      }
    catch (const InputError &error)
      {
        std::cout << error.what() << std::endl;
      }
  }

  template <int dim>
  void
  write_mesh(const std::vector<std::string> &overrides,
             const std::string              &file_name)
  {
    Triangulation<dim> mesh;
    Scene<dim>(parameters(overrides)).make_coarse_mesh(mesh);
    GridOut grid_out;
    grid_out.set_flags(GridOutFlags::Msh(true, true));
    std::ofstream file(file_name);
    file.precision(17);
    grid_out.write_msh(mesh, file);
  }
} // namespace test_geometry



TEST(geometry)
{
  std::cout.precision(4);

  half_disc();
  small_disc();
  small_half_ball();
  ring_cells();
  ring<2>({"Scene/Geometry=half disc"});
  ring<2>({"Scene/Geometry=half disc", "Scene/Rotation angle=20"});
  ring<3>({"Scene/Geometry=cylinder"});
  ring<3>({"Scene/Geometry=cylinder", "Scene/Rotation angle=20"});
  ring<3>({"Scene/Geometry=half cylinder",
           "Scene/Layers=1",
           "Scene/Rotation angle=20"});
  print<2>({"Scene/Subdivisions=2, 2", "Scene/Size=3, 1"});
  print<2>({"Scene/Subdivisions=2, 2", "Scene/Distortion=0.3"});
  print<2>({"Scene/Rotation angle=90"});
  print<3>({"Scene/Subdivisions=2, 2, 3",
            "Scene/Size=1, 2, 3",
            "Scene/Distortion=0.3",
            "Boundary conditions/Displacement=5: 0, 0, 0"});

  // A mesh file, and a file that is none.
  write_mesh<2>({}, "square.msh");
  write_mesh<3>({"Scene/Subdivisions=2, 2, 3",
                 "Scene/Size=1, 2, 3",
                 "Scene/Distortion=0.3",
                 "Boundary conditions/Displacement=5: 0, 0, 0"},
                "box.msh");
  std::ofstream("bad.msh") << "nonsense\n";
  std::ofstream("triangle.msh")
    << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
       "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
       "$Elements\n1\n1 2 2 0 0 1 2 3\n$EndElements\n";
  print<2>({"Scene/Geometry=mesh file", "Scene/Mesh file=square.msh"});
  print<3>({"Scene/Geometry=mesh file",
            "Scene/Mesh file=box.msh",
            "Boundary conditions/Displacement=5: 0, 0, 0"});
  check<2>({"Scene/Geometry=mesh file", "Scene/Mesh file=triangle.msh"});
  check<3>({"Scene/Geometry=mesh file",
            "Scene/Mesh file=square.msh",
            "Boundary conditions/Displacement=3: 0, 0, 0"});
  check<2>({"Scene/Geometry=mesh file", "Scene/Mesh file=bad.msh"});
  check<2>({"Scene/Geometry=mesh file", "Scene/Mesh file=no.msh"});

  check<3>({"Scene/Geometry=half disc",
            "Boundary conditions/Displacement=1: 0, 0, 0"});
  check<2>({"Scene/Size=1, 1, 1"});
  check<2>({"Scene/Subdivisions=4"});
  check<2>({"Contact/Boundary id=7"});
  check<2>({"Boundary conditions/Displacement=4: 0, 0"});
  check<2>({"Boundary conditions/Displacement=top: 0, 0"});
  check<2>({"Boundary conditions/Displacement=1: 0"});
  check<2>({"Boundary conditions/Displacement=1: 0, sqrt("});
  check<2>({"Boundary conditions/Displacement="});
  check<2>({"Boundary conditions/Displacement=1: 0, free"});
  check<2>({"Boundary conditions/Displacement=1: 0, free",
            "Boundary conditions/Pinned points=(1, 0): free, 0"});
  check<2>({"Boundary conditions/Displacement=1: 0, free",
            "Boundary conditions/Pinned points=(1, 0): free, 0",
            "Scene/Rotation angle=10"});
  check<2>({"Boundary conditions/Pinned points=(0.5, 0): free, 0"});
  check<2>({"Boundary conditions/Pinned points=0.5: free, 0"});
  check<2>({"Boundary conditions/Traction=9: 1, 0"});
  check<2>({"Boundary conditions/Body force=1"});
}
