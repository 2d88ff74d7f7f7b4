#include <common/printable.h>
#include <common/scene/extruded_manifold.h>
#include <common/scene/geometries.h>
#include <common/scene/ring_manifold.h>
#include <common/scene/round_manifolds.h>
#include <common/scene/shell_manifold.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/utilities.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <vector>

namespace Friction
{
  namespace
  {
    // The round part of the boundary, and the cells along it, which pass from
    // its shape to straight sides.
    constexpr types::manifold_id round_manifold_id = 0;
    constexpr types::manifold_id ring_manifold_id  = 1;



    // Vertices and cells before they become a triangulation. Cells with
    // straight sides have the flat manifold id, all others that of the ring.
    template <int dim>
    struct Mesh
    {
      std::vector<Point<dim>>    vertices;
      std::vector<CellData<dim>> cells;

      void
      add_cell(const std::vector<unsigned int> &cell_vertices,
               const types::manifold_id         manifold)
      {
        cells.emplace_back();
        cells.back().vertices.assign(cell_vertices.begin(),
                                     cell_vertices.end());
        cells.back().material_id = 0;
        cells.back().manifold_id = manifold;
      }
    };



    // The lower half disc as an O-grid: a core of 4 x 4 cells and two rings
    // around its left, lower and right sides, 51 vertices and 40 cells
    // altogether, symmetric about x = 0; only the outer ring has curved sides.
    // The positions of the interior vertices minimise the sum over all corners
    // of all cells of the sixth power of the deviation from a square,
    // |J|^2/(2 det J), with the tangent in place of the chord along the arc.
    // However fine the mesh, angles stay between 59 and 121 degrees; three
    // cells meet in each lower corner of the core, which leaves nothing below
    // 120, and 60 opposite to it, to be hoped for.
    Mesh<2>
    half_disc(const double radius)
    {
      // The right half, by rows from below.
      const double core[5][3][2] = {
        {{.000, -.644}, {.164, -.639}, {.290, -.622}},
        {{.000, -.490}, {.173, -.492}, {.336, -.509}},
        {{.000, -.333}, {.189, -.338}, {.382, -.359}},
        {{.000, -.169}, {.202, -.172}, {.416, -.185}},
        {{.000, .000}, {.207, .000}, {.428, .000}}};
      // Between the rings, anticlockwise from the lowest point.
      const double between[7][2] = {{.000, -.808},
                                    {.201, -.789},
                                    {.370, -.723},
                                    {.495, -.589},
                                    {.594, -.415},
                                    {.659, -.214},
                                    {.681, .000}};

      const auto core_vertex = [](const unsigned int i, const unsigned int j) {
        return 5 * j + i;
      };
      // Vertex k of the 13 on the rim of the core (r = 0), between the rings
      // (r = 1) and on the arc (r = 2), all from the left to the right.
      const auto ring_vertex = [&](const unsigned int r, const unsigned int k) {
        if (r > 0)
          return 25 + 13 * (r - 1) + k;
        return (k <= 4     ? core_vertex(0, 4 - k)
                  : k <= 8 ? core_vertex(k - 4, 0)
                           : core_vertex(4, k - 8));
      };

      Mesh<2> mesh;
      mesh.vertices.resize(51);
      for (unsigned int j = 0; j < 5; ++j)
        for (unsigned int i = 0; i < 3; ++i)
          {
            const Point<2> p(radius * core[j][i][0], radius * core[j][i][1]);
            mesh.vertices[core_vertex(2 + i, j)] = p;
            mesh.vertices[core_vertex(2 - i, j)] = Point<2>(-p[0], p[1]);
          }
      for (unsigned int k = 0; k < 7; ++k)
        {
          const double angle = k * numbers::PI / 12.;
          const double x = radius * between[k][0], y = radius * between[k][1];
          const double arc_x = (k == 0) ? 0. : radius * std::sin(angle);
          const double arc_y = (k == 6) ? 0. : -radius * std::cos(angle);
          mesh.vertices[ring_vertex(1, 6 + k)] = Point<2>(x, y);
          mesh.vertices[ring_vertex(1, 6 - k)] = Point<2>(-x, y);
          mesh.vertices[ring_vertex(2, 6 + k)] = Point<2>(arc_x, arc_y);
          mesh.vertices[ring_vertex(2, 6 - k)] = Point<2>(-arc_x, arc_y);
        }

      for (unsigned int j = 0; j < 4; ++j)
        for (unsigned int i = 0; i < 4; ++i)
          mesh.add_cell({core_vertex(i, j),
                         core_vertex(i + 1, j),
                         core_vertex(i, j + 1),
                         core_vertex(i + 1, j + 1)},
                        numbers::flat_manifold_id);
      for (unsigned int r = 0; r < 2; ++r)
        for (unsigned int k = 0; k < 12; ++k)
          mesh.add_cell({ring_vertex(r + 1, k),
                         ring_vertex(r + 1, k + 1),
                         ring_vertex(r, k),
                         ring_vertex(r, k + 1)},
                        r == 0 ? numbers::flat_manifold_id : ring_manifold_id);
      GridTools::consistently_order_cells(mesh.cells);
      return mesh;
    }



    // The disc as an O-grid: a core of two trapezoids in one ring of 6, 8 cells
    // and 12 vertices altogether, symmetric about both axes. The vertices of
    // the core are those of a hexagon, whose angles of 120 degrees suit the
    // places where three cells meet; it is drawn in a little where four meet,
    // which widens the acute angles there. However fine the mesh, angles stay
    // between 57 and 123 degrees. Of the 6 vertices on the circle, two lie 30
    // degrees to the left and right of the lowest point, which is where the
    // rods of scene 'cylinder' touch.
    Mesh<2>
    disc(const double radius)
    {
      // Around the core and around the disc, anticlockwise from the lower left.
      Mesh<2> mesh;
      for (const auto &[on_axis, others] :
           {std::make_pair(.47, .5), std::make_pair(1., 1.)})
        {
          const double a = radius * on_axis, b = radius * others;
          const double x = b * .5, y = b * std::sqrt(.75);
          for (const Point<2> &p : {Point<2>(-x, -y),
                                    Point<2>(x, -y),
                                    Point<2>(a, 0),
                                    Point<2>(x, y),
                                    Point<2>(-x, y),
                                    Point<2>(-a, 0)})
            mesh.vertices.push_back(p);
        }

      mesh.add_cell({0, 1, 5, 2}, numbers::flat_manifold_id);
      mesh.add_cell({5, 2, 4, 3}, numbers::flat_manifold_id);
      for (unsigned int k = 0; k < 6; ++k)
        mesh.add_cell({6 + k, 6 + (k + 1) % 6, k, (k + 1) % 6},
                      ring_manifold_id);
      GridTools::consistently_order_cells(mesh.cells);
      return mesh;
    }



    // A square with its four corners on the circle: what remains of the round
    // boundary if the mesh has but one cell.
    Mesh<2>
    inscribed_square(const double radius)
    {
      const double d = std::sqrt(.5) * radius;
      Mesh<2>      mesh;
      mesh.vertices = {
        Point<2>(-d, -d), Point<2>(d, -d), Point<2>(-d, d), Point<2>(d, d)};
      mesh.add_cell({0, 1, 2, 3}, numbers::flat_manifold_id);
      return mesh;
    }



    // Layers of cells over a plane mesh, from z = 0 to z = length.
    Mesh<3>
    extrude(const Mesh<2>     &section,
            const double       length,
            const unsigned int n_layers)
    {
      const unsigned int n = section.vertices.size();
      Mesh<3>            mesh;
      for (unsigned int layer = 0; layer <= n_layers; ++layer)
        for (const Point<2> &p : section.vertices)
          mesh.vertices.emplace_back(p[0], p[1], layer * length / n_layers);
      for (unsigned int layer = 0; layer < n_layers; ++layer)
        for (const CellData<2> &cell : section.cells)
          {
            std::vector<unsigned int> vertices;
            for (unsigned int l = layer; l <= layer + 1; ++l)
              for (const unsigned int v : cell.vertices)
                vertices.push_back(n * l + v);
            mesh.add_cell(vertices, cell.manifold_id);
          }
      return mesh;
    }



    // The lower half ball: a core of 2 x 2 x 1 cells, blown up as that of the
    // disc, and a shell of 12 cells, 4 of which meet in the lowest point. In
    // the corners of the core four cells meet, and the directions to their
    // common neighbours are nearly those from the centre of a tetrahedron to
    // its vertices; so the edges of a cell, brought to length one, span a
    // volume of 0.758 there, of 0.770 possible, on any refinement.
    Mesh<3>
    half_ball(const double radius)
    {
      // Distances from the centre of those vertices of the core that lie in the
      // middle of a side of the cube that it once was, in the middle of an
      // edge, and in a corner.
      const double distance[4] = {0., radius * .52, radius * .58, radius * .60};

      // A place in the core: -1, 0 or 1 in each direction, at most 0 upwards.
      using Place         = std::array<int, 3>;
      const auto is_outer = [](const Place &p) {
        return p[0] * p[0] == 1 || p[1] * p[1] == 1 || p[2] == -1;
      };
      Mesh<3>                       mesh;
      std::map<Place, unsigned int> core, sphere;
      for (int k = -1; k <= 0; ++k)
        for (int j = -1; j <= 1; ++j)
          for (int i = -1; i <= 1; ++i)
            {
              const Point<3>     direction(i, j, k);
              const unsigned int n_nonzero = i * i + j * j + k * k;
              const double       norm      = std::max(1., direction.norm());
              core[{{i, j, k}}]            = mesh.vertices.size();
              mesh.vertices.push_back((distance[n_nonzero] / norm) * direction);
              if (!is_outer({{i, j, k}}))
                continue;
              sphere[{{i, j, k}}] = mesh.vertices.size();
              mesh.vertices.push_back((radius / norm) * direction);
            }

      for (int j = -1; j <= 0; ++j)
        for (int i = -1; i <= 0; ++i)
          {
            std::vector<unsigned int> vertices;
            for (unsigned int v = 0; v < 8; ++v)
              vertices.push_back(core.at(
                {{i + int(v % 2), j + int(v / 2 % 2), -1 + int(v / 4)}}));
            mesh.add_cell(vertices, numbers::flat_manifold_id);
          }

      // The four corners of each side of the core, continued to the sphere.
      const auto add_shell_cell = [&](std::array<Place, 4> side) {
        // The first two directions and the third, outwards, are to be a right
        // hand.
        const auto at = [&](const unsigned int v) {
          return mesh.vertices[core.at(side[v])];
        };
        const Tensor<1, 3> outwards = mesh.vertices[sphere.at(side[0])] - at(0);
        if (cross_product_3d(at(1) - at(0), at(2) - at(0)) * outwards < 0.)
          std::swap(side[1], side[2]);
        std::vector<unsigned int> vertices;
        for (const Place &p : side)
          vertices.push_back(core.at(p));
        for (const Place &p : side)
          vertices.push_back(sphere.at(p));
        mesh.add_cell(vertices, ring_manifold_id);
      };
      for (int a = -1; a <= 0; ++a)
        {
          for (int b = -1; b <= 0; ++b)
            add_shell_cell({{{{a, b, -1}},
                             {{a + 1, b, -1}},
                             {{a, b + 1, -1}},
                             {{a + 1, b + 1, -1}}}});
          for (int side = -1; side <= 1; side += 2)
            {
              add_shell_cell({{{{side, a, -1}},
                               {{side, a + 1, -1}},
                               {{side, a, 0}},
                               {{side, a + 1, 0}}}});
              add_shell_cell({{{{a, side, -1}},
                               {{a + 1, side, -1}},
                               {{a, side, 0}},
                               {{a + 1, side, 0}}}});
            }
        }
      GridTools::consistently_order_cells(mesh.cells);
      return mesh;
    }



    // Make the triangulation of a body with a round boundary. Of a face on the
    // boundary, flat_id says to which flat part it belongs, in terms of its
    // centre; the answer 0 means that it belongs to none, but to the round
    // part. Edges in the flat part straight_id are straight as well; in the
    // others they follow the round boundary like those inside.
    template <int dim, typename FlatId>
    void
    create(const Mesh<dim>         &mesh,
           const FlatId            &flat_id,
           const types::boundary_id straight_id,
           Triangulation<dim>      &triangulation)
    {
      triangulation.create_triangulation(
        mesh.vertices, mesh.cells, SubCellData());

      // The ring follows the round boundary, other cells are left straight;
      // they have the last word about what they share.
      for (const types::manifold_id id :
           {ring_manifold_id, numbers::flat_manifold_id})
        for (const auto &cell : triangulation.active_cell_iterators())
          if (cell->manifold_id() == id)
            cell->set_all_manifold_ids(id);

      // Flat parts first, so that the rims are round.
      for (const bool round : {false, true})
        for (const auto &cell : triangulation.active_cell_iterators())
          for (const auto &face : cell->face_iterators())
            if (face->at_boundary())
              {
                const types::boundary_id id = flat_id(face->center());
                if ((id == 0) != round)
                  continue;
                face->set_all_boundary_ids(id);
                if (round)
                  face->set_all_manifold_ids(round_manifold_id);
                else if (id == straight_id)
                  face->set_all_manifold_ids(numbers::flat_manifold_id);
              }
    }



    // Random numbers by a generator that is the same everywhere, unlike the
    // distributions of the standard library.
    template <int dim>
    void
    distort(const double         fraction,
            const Tensor<1, dim> cell_size,
            Triangulation<dim>  &triangulation)
    {
      std::vector<bool> at_boundary(triangulation.n_vertices(), false);
      for (const auto &cell : triangulation.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            for (const unsigned int v : cell->face(f)->vertex_indices())
              at_boundary[cell->face(f)->vertex_index(v)] = true;

      std::mt19937      generator(1);
      std::vector<bool> moved(triangulation.n_vertices(), false);
      for (const auto &cell : triangulation.active_cell_iterators())
        for (const unsigned int v : cell->vertex_indices())
          {
            const unsigned int index = cell->vertex_index(v);
            if (at_boundary[index] || moved[index])
              continue;
            moved[index] = true;
            Tensor<1, dim> shift;
            for (unsigned int d = 0; d < dim; ++d)
              shift[d] = 2. * generator() / generator.max() - 1.;
            if (shift.norm() > 1.)
              shift /= shift.norm();
            for (unsigned int d = 0; d < dim; ++d)
              cell->vertex(v)[d] += fraction * cell_size[d] * shift[d];
          }
    }



    void
    set_round_manifold(const Parameters::Scene &,
                       Triangulation<2> &triangulation)
    {
      triangulation.set_manifold(round_manifold_id, Spheres<2>());
    }



    void
    set_round_manifold(const Parameters::Scene &scene,
                       Triangulation<3>        &triangulation)
    {
      if (scene.geometry == GeometryKind::half_ball)
        triangulation.set_manifold(round_manifold_id, Spheres<3>());
      else
        triangulation.set_manifold(round_manifold_id, Mantle());
    }



    // Along a cylinder: so many that cells are about as long as those of its
    // section are wide, relative to the radius. It may be too large for an
    // integer, see n_coarse_cells().
    double
    n_layers(const Parameters::Scene &scene)
    {
      const bool is_whole = scene.geometry == GeometryKind::cylinder;
      if (is_whole && scene.coarse_grid == CoarseGrid::one_cell)
        return 1.;
      const double width = is_whole ? .6 : .2;
      return scene.layers > 0
        ? scene.layers
        : std::max(1., std::round(scene.length / (width * scene.radius)));
    }



    // There is such a body, but not in this dimension.
    InputError
    no_such_body(const std::string &where,
                 const std::string &name,
                 const unsigned int its_dimension)
    {
      return InputError(where + "'Scene/Geometry' is '" + name +
                        "', which there is in " +
                        (its_dimension == 2 ? "two" : "three") +
                        " dimensions only; choose another geometry, or give "
                        "the scene to step-friction-" +
                        Utilities::int_to_string(its_dimension) + "d.");
    }



    // The half disc, and the cross-sections of both cylinders.
    Mesh<2>
    section_of(const Parameters::Scene &scene)
    {
      if (scene.geometry != GeometryKind::cylinder)
        return half_disc(scene.radius);
      return scene.coarse_grid == CoarseGrid::one_cell
        ? inscribed_square(scene.radius)
        : disc(scene.radius);
    }



    void
    make_section(const Parameters::Scene &scene,
                 Triangulation<2>        &triangulation)
    {
      const bool   is_half   = scene.geometry != GeometryKind::cylinder;
      const double tolerance = 1e-10 * scene.radius;
      create(
        section_of(scene),
        [=](const Point<2> &p) { return is_half && p[1] > -tolerance ? 1 : 0; },
        1,
        triangulation);
    }



    void
    make_round_body(const Parameters::Scene &scene,
                    const std::string       &where,
                    Triangulation<2>        &triangulation)
    {
      if (scene.geometry != GeometryKind::half_disc)
        throw no_such_body(where,
                           scene.geometry == GeometryKind::cylinder ? "cylinder"
                             : scene.geometry == GeometryKind::half_cylinder
                             ? "half cylinder"
                             : "half ball",
                           3);
      make_section(scene, triangulation);
    }



    void
    make_round_body(const Parameters::Scene &scene,
                    const std::string       &where,
                    Triangulation<3>        &triangulation)
    {
      const double R = scene.radius, length = scene.length;
      const double tolerance = 1e-10 * std::min(R, length);
      const auto   end_id = [=](const Point<3> &p, const unsigned int first) {
        return p[2] < tolerance       ? first
            : p[2] > length - tolerance ? first + 1
                                        : 0u;
      };

      const auto layers = [&]() {
        return extrude(section_of(scene),
                       length,
                       static_cast<unsigned int>(n_layers(scene)));
      };

      if (scene.geometry == GeometryKind::half_disc)
        throw no_such_body(where, "half disc", 2);
      else if (scene.geometry == GeometryKind::cylinder)
        create(
          layers(),
          [=](const Point<3> &p) { return end_id(p, 1); },
          numbers::invalid_boundary_id,
          triangulation);
      else if (scene.geometry == GeometryKind::half_cylinder)
        create(
          layers(),
          [=](const Point<3> &p) {
            return p[1] > -tolerance ? 1u : end_id(p, 2);
          },
          1,
          triangulation);
      else
        create(
          half_ball(R),
          [=](const Point<3> &p) { return p[2] > -tolerance ? 1 : 0; },
          numbers::invalid_boundary_id,
          triangulation);
    }



    void
    set_ring_manifold(const Parameters::Scene &, Triangulation<2> &disc)
    {
      disc.set_manifold(
        ring_manifold_id,
        RingManifold(disc, ring_manifold_id, round_manifold_id));
    }



    // Of a body along the z axis it is that of the section, turned as the body
    // is.
    void
    set_ring_manifold(const Parameters::Scene &scene,
                      Triangulation<3>        &triangulation)
    {
      if (scene.geometry == GeometryKind::half_ball)
        {
          triangulation.set_manifold(
            ring_manifold_id,
            ShellManifold(triangulation, ring_manifold_id, round_manifold_id));
          return;
        }
      Triangulation<2> section;
      make_section(scene, section);
      GridTools::rotate(scene.rotation_angle * numbers::PI / 180., section);
      triangulation.set_manifold(
        ring_manifold_id,
        ExtrudedManifold(std::make_shared<RingManifold>(
          section, ring_manifold_id, round_manifold_id)));
    }



    template <int dim>
    void
    make_rectangle(const Parameters::Scene &scene,
                   const std::string       &where,
                   Triangulation<dim>      &triangulation)
    {
      // Nothing said means ones.
      std::vector<double>       size         = scene.size;
      std::vector<unsigned int> subdivisions = scene.subdivisions;
      if (size.empty())
        size.resize(dim, 1.);
      if (subdivisions.empty())
        subdivisions.resize(dim, 1);
      const auto check = [&](const std::size_t n, const std::string &entry) {
        if (n != dim)
          throw InputError(where + "'Scene/" + entry + "' " +
                           wrong_number(dim, n, "numbers"));
      };
      check(size.size(), "Size");
      check(subdivisions.size(), "Subdivisions");

      Point<dim>     corner;
      Tensor<1, dim> cell_size;
      for (unsigned int d = 0; d < dim; ++d)
        {
          corner[d]    = size[d];
          cell_size[d] = size[d] / subdivisions[d];
        }
      GridGenerator::subdivided_hyper_rectangle(
        triangulation, subdivisions, Point<dim>(), corner, true);

      // deal.II numbers not only the sides, but quarters of the body, too.
      for (const auto &cell : triangulation.active_cell_iterators())
        cell->set_material_id(0);
      if (scene.distortion > 0.)
        distort(scene.distortion, cell_size, triangulation);
    }
  } // namespace



  double
  n_coarse_cells(const Parameters::Scene &scene)
  {
    switch (scene.geometry)
      {
        case GeometryKind::rectangle:
          {
            double product = 1.;
            for (const unsigned int n : scene.subdivisions)
              product *= n;
            return product;
          }
        case GeometryKind::cylinder:
        case GeometryKind::half_cylinder:
          return section_of(scene).cells.size() * n_layers(scene);
        default:
          return 0.;
      }
  }



  template <int dim>
  void
  make_geometry(const Parameters::Scene &scene,
                const std::string       &where,
                Triangulation<dim>      &triangulation)
  {
    switch (scene.geometry)
      {
        case GeometryKind::half_disc:
        case GeometryKind::cylinder:
        case GeometryKind::half_cylinder:
        case GeometryKind::half_ball:
          make_round_body(scene, where, triangulation);
          break;
        case GeometryKind::rectangle:
          make_rectangle(scene, where, triangulation);
          break;
        case GeometryKind::mesh_file:
          Assert(false, ExcMessage("A mesh file has a class of its own."));
          break;
      }
  }



  template <int dim>
  void
  set_manifolds(const Parameters::Scene &scene,
                Triangulation<dim>      &triangulation)
  {
    if (scene.geometry == GeometryKind::rectangle ||
        scene.geometry == GeometryKind::mesh_file)
      return;

    set_round_manifold(scene, triangulation);
    if (scene.geometry == GeometryKind::cylinder &&
        scene.coarse_grid == CoarseGrid::one_cell)
      return;
    set_ring_manifold(scene, triangulation);
  }



  template void make_geometry(const Parameters::Scene &,
                              const std::string &,
                              Triangulation<2> &);
  template void make_geometry(const Parameters::Scene &,
                              const std::string &,
                              Triangulation<3> &);
  template void set_manifolds(const Parameters::Scene &, Triangulation<2> &);
  template void set_manifolds(const Parameters::Scene &, Triangulation<3> &);
} // namespace Friction
