// The round bodies in three dimensions: sizes and their convergence, boundary
// ids, vertices and normals on the round boundary, symmetry, and the shape of
// cells after refinement, which stays good but for the one-cell grid. The
// half cylinder's cross-section is the half disc. Defaults and wrong scenes.

#include <common/scene/scene.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/fe/fe_nothing.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>

#include <deal.II/grid/grid_tools.h>

#include <array>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <set>
#include <tuple>

#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;

namespace test_geometry_3d
{
  Parameters
  parameters(const std::vector<std::string> &overrides, const int dim = 3)
  {
    std::ofstream("scene.prm")
      << "subsection Boundary conditions\n  set Displacement = 1: 0, 0"
      << (dim == 3 ? ", 0" : "") << "\nend\n";
    return read_parameters("scene.prm", overrides);
  }



  template <int dim>
  using DistributedMesh = parallel::distributed::Triangulation<dim>;

  template <int dim>
  std::unique_ptr<DistributedMesh<dim>>
  make_mesh(const Scene<dim> &scene)
  {
    auto mesh = std::make_unique<DistributedMesh<dim>>(
      MPI_COMM_WORLD,
      Triangulation<dim>::limit_level_difference_at_vertices,
      DistributedMesh<dim>::construct_multigrid_hierarchy);
    scene.make_coarse_mesh(*mesh);
    return mesh;
  }



  struct Quality
  {
    double smallest_angle = 180., largest_angle = 0.; ///< degrees

    /// Smallest volume spanned by the three edges of a cell at a vertex, after
    /// they have been brought to length one.
    double scaled_jacobian = 1.;
  };

  Quality
  measure_quality(const Triangulation<3> &mesh)
  {
    Quality quality;
    for (const auto &cell : mesh.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        {
          std::array<Tensor<1, 3>, 3> edges;
          double                      sign = 1.;
          for (unsigned int d = 0; d < 3; ++d)
            {
              // The neighbour whose number differs in one binary digit.
              edges[d] = cell->vertex(v ^ (1u << d)) - cell->vertex(v);
              edges[d] /= edges[d].norm();
              sign *= ((v >> d) & 1u) == 1 ? -1. : 1.;
            }
          for (unsigned int d = 0; d < 3; ++d)
            {
              const double cosine    = edges[d] * edges[(d + 1) % 3];
              const double angle     = std::acos(cosine) * 180. / numbers::PI;
              quality.smallest_angle = std::min(quality.smallest_angle, angle);
              quality.largest_angle  = std::max(quality.largest_angle, angle);
            }
          quality.scaled_jacobian =
            std::min(quality.scaled_jacobian,
                     sign * cross_product_3d(edges[0], edges[1]) * edges[2]);
        }
    return quality;
  }



  // The outward normal of the round boundary at a point on it, and how far the
  // point is from it.
  using Round = std::function<Tensor<1, 3>(const Point<3> &)>;

  void
  check(const std::string                          &name,
        const std::vector<std::string>             &overrides,
        const unsigned int                          n_levels,
        const double                                volume,
        const std::map<types::boundary_id, double> &areas,
        const Round                                &radial,
        const double                                radius)
  {
    const Scene<3>      scene(parameters(overrides));
    const auto          mesh = make_mesh(scene);
    const QGauss<2>     quadrature(2);
    const FE_Nothing<3> element;
    const MappingQ1<3>  mapping;
    FEFaceValues<3>     face_values(
      mapping, element, quadrature, update_JxW_values | update_normal_vectors);

    std::cout << name << std::endl;
    double last_volume_error = 0., last_area_error = 0.;
    for (unsigned int level = 0; level < n_levels; ++level)
      {
        std::map<types::boundary_id, double> measured;
        double                               off_boundary = 0., off_normal = 0.;
        for (const auto &cell : mesh->active_cell_iterators())
          for (const unsigned int f : cell->face_indices())
            if (cell->at_boundary(f))
              {
                const auto face = cell->face(f);
                face_values.reinit(cell, f);
                for (const unsigned int q :
                     face_values.quadrature_point_indices())
                  measured[face->boundary_id()] += face_values.JxW(q);
                if (face->boundary_id() != 0)
                  continue;
                for (const unsigned int v : face->vertex_indices())
                  {
                    const Tensor<1, 3> r = radial(face->vertex(v));
                    Tensor<1, 3>       normal =
                      face->get_manifold().normal_vector(face, face->vertex(v));
                    normal /= normal.norm();
                    if (normal * face_values.normal_vector(0) < 0.)
                      normal *= -1.;
                    off_boundary =
                      std::max(off_boundary, std::abs(r.norm() - radius));
                    off_normal =
                      std::max(off_normal, (normal - r / r.norm()).norm());
                  }
              }

        // Vertices in a grid much finer than the mesh, to find mirror images.
        const auto place = [](const double x) { return std::lround(x * 1e7); };
        std::set<std::tuple<long, long, long>> places;
        for (const Point<3> &v : mesh->get_vertices())
          places.insert(std::make_tuple(place(v[0]), place(v[1]), place(v[2])));
        unsigned int n_lonely = 0;
        for (const Point<3> &v : mesh->get_vertices())
          {
            bool found = false;
            for (int i = -1; i <= 1; ++i)
              for (int j = -1; j <= 1; ++j)
                for (int k = -1; k <= 1; ++k)
                  found = found ||
                    places.count(std::make_tuple(
                      place(-v[0]) + i, place(v[1]) + j, place(v[2]) + k)) == 1;
            n_lonely += found ? 0 : 1;
          }

        // The top of the half cylinder is exact from the beginning.
        double area_error = 0.;
        for (const auto &[id, area] : areas)
          area_error = std::max(area_error, std::abs(measured[id] - area));
        const double volume_error = std::abs(GridTools::volume(*mesh) - volume);

        const Quality quality = measure_quality(*mesh);
        std::cout << "  " << mesh->n_active_cells() << " cells "
                  << mesh->n_used_vertices() << " vertices, ids";
        for (const auto &entry : measured)
          std::cout << ' ' << entry.first;
        std::cout << ", off boundary " << (off_boundary > 1e-13)
                  << ", off normal " << (off_normal > 1e-15)
                  << ", not mirrored " << n_lonely << ", angles "
                  << std::lround(quality.smallest_angle) << ' '
                  << std::lround(quality.largest_angle) << ", Jacobian "
                  << std::lround(100 * quality.scaled_jacobian) << " %";
        if (level > 0)
          std::cout << ", errors fall by "
                    << std::lround(last_volume_error / volume_error) << ' '
                    << std::lround(last_area_error / area_error);
        std::cout << std::endl;
        last_volume_error = volume_error;
        last_area_error   = area_error;
        if (level + 1 < n_levels)
          mesh->refine_global();
      }
  }



  // Whether the vertices of the half cylinder are those of the half disc, in
  // equidistant layers. In either mesh deal.II's iterations find a point of a
  // coarse cell to 3e-11 of its diameter, here at most half of the radius; the
  // middle of a cell is a mean of eight, whose weights have the sum of moduli
  // 3, and errors of the levels add.
  void
  cross_section()
  {
    const double radius = 2., length = .9;
    const auto   disc = make_mesh(
      Scene<2>(parameters({"Scene/Geometry=half disc", "Scene/Radius=2"}, 2)));
    const auto cylinder = make_mesh(Scene<3>(parameters(
      {"Scene/Geometry=half cylinder", "Scene/Radius=2", "Scene/Length=0.9"})));
    std::cout << "cross-section" << std::endl;
    for (unsigned int level = 0; level < 4; ++level)
      {
        std::map<std::array<long, 2>, Point<2>> places;
        const auto place = [](const double x) { return std::lround(x * 1e6); };
        for (const Point<2> &v : disc->get_vertices())
          places[{{place(v[0]), place(v[1])}}] = v;

        const unsigned int n_layers = 2 << level;
        double             off      = 0.;
        unsigned int       n_lost   = 0;
        for (const Point<3> &v : cylinder->get_vertices())
          {
            const double layer = v[2] * n_layers / length;
            off        = std::max(off, std::abs(layer - std::round(layer)));
            bool found = false;
            for (int i = -1; i <= 1; ++i)
              for (int j = -1; j <= 1; ++j)
                {
                  const auto it =
                    places.find({{place(v[0]) + i, place(v[1]) + j}});
                  if (it == places.end())
                    continue;
                  found = true;
                  off =
                    std::max(off, it->second.distance(Point<2>(v[0], v[1])));
                }
            n_lost += found ? 0 : 1;
          }
        std::cout << "  " << disc->n_used_vertices() << " vertices, as many in "
                  << double(cylinder->n_used_vertices()) /
            disc->n_used_vertices()
                  << " layers, not found " << n_lost << ", off "
                  << (off > 1e-9 * radius) << std::endl;
        if (level < 3)
          {
            disc->refine_global();
            cylinder->refine_global();
          }
      }
  }



  template <int dim>
  void
  print(const std::vector<std::string> &overrides)
  {
    try
      {
        const Scene<dim>   scene(parameters(overrides, dim));
        Triangulation<dim> mesh;
        scene.make_coarse_mesh(mesh);
        std::cout << mesh.n_active_cells() << " cells, volume "
                  << GridTools::volume(mesh) << std::endl;
      }
    catch (const InputError &error)
      {
        std::cout << error.what() << std::endl;
      }
  }
} // namespace test_geometry_3d

TEST(geometry_3d)
{
  std::cout.precision(4);

  const double pi        = numbers::PI;
  const Round  from_axis = [](const Point<3> &p) {
    return Tensor<1, 3>({p[0], p[1], 0.});
  };
  const Round from_center = [](const Point<3> &p) { return Tensor<1, 3>(p); };

  check("cylinder",
        {"Scene/Geometry=cylinder"},
        4,
        2. * pi,
        {{0, 4. * pi}, {1, pi}, {2, pi}},
        from_axis,
        1.);
  check("cylinder, turned by a right angle",
        {"Scene/Geometry=cylinder",
         "Scene/Radius=0.5",
         "Scene/Length=0.3",
         "Scene/Rotation angle=90"},
        3,
        .3 * pi / 4.,
        {{0, .3 * pi}, {1, pi / 4.}, {2, pi / 4.}},
        from_axis,
        .5);
  check("cylinder of one cell",
        {"Scene/Geometry=cylinder", "Scene/Coarse grid=one cell"},
        5,
        2. * pi,
        {{0, 4. * pi}, {1, pi}, {2, pi}},
        from_axis,
        1.);
  check("half cylinder",
        {"Scene/Geometry=half cylinder", "Scene/Length=0.2"},
        3,
        .1 * pi,
        {{0, .2 * pi}, {1, .4}, {2, pi / 2.}, {3, pi / 2.}},
        from_axis,
        1.);
  check("half ball",
        {"Scene/Geometry=half ball", "Scene/Radius=2"},
        4,
        16. / 3. * pi,
        {{0, 8. * pi}, {1, 4. * pi}},
        from_center,
        2.);
  cross_section();

  // Layers, and defaults that are good in either dimension.
  std::cout << "others" << std::endl;
  print<3>({"Scene/Geometry=cylinder", "Scene/Layers=7"});
  print<3>({"Scene/Geometry=cylinder", "Scene/Length=0.01"});
  print<3>({"Scene/Geometry=half cylinder"});
  print<2>({});
  print<3>({});
  print<2>({"Obstacle/Kind=plane"});
  print<3>({"Obstacle/Kind=plane"});

  // Scenes of the other dimension.
  print<2>({"Boundary conditions/Displacement=1: 0, 0, 0"});
  print<3>({"Boundary conditions/Displacement=1: 0, 0"});
  print<3>({"Boundary conditions/Displacement=1: 0"});
  print<3>({"Obstacle/Kind=plane", "Obstacle/Point=0, -1"});
  print<3>({"Scene/Size=1, 1"});
  print<3>({"Boundary conditions/Pinned points=(0, 0): 0, 0, 0"});
  print<3>({"Boundary conditions/Pinned points=0: 0, 0, 0"});
  print<3>({"Obstacle/Kind=rods", "Obstacle/Centers=0, -2, 0"});
  print<3>({"Scene/Geometry=half disc"});
  print<2>({"Scene/Geometry=cylinder"});
  print<2>({"Scene/Geometry=half cylinder"});
  print<2>({"Scene/Geometry=half ball"});
}
