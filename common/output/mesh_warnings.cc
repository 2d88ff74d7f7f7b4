#include <common/output/mesh_warnings.h>
#include <common/printable.h>
#include <common/scene/rigid_motions.h>
#include <common/scene/seams.h>

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <map>

namespace Friction
{
  namespace
  {
    // Edges of a boundary that is meant to be smooth are flatter than the
    // first, and do not matter if they are flatter than the second; degrees.
    constexpr double smallest_corner = 40., smallest_edge = 3.;
  } // namespace



  template <int dim>
  std::vector<std::string>
  warnings_about_cuts(const Triangulation<dim> &mesh)
  {
    std::vector<std::string> warnings;
    const auto one_of_them = [](const Seam<dim> &seam, const std::string &lie) {
      return lie + (seam.n == 1 ? ", at " : ", one of them at ") +
        coordinates(seam.where) + ", so that the body is cut there; ";
    };
    const std::string faces = dim == 2 ? "edges" : "faces";
    const Seam<dim>   pairs = faces_on_each_other(mesh);
    if (pairs.n > 0)
      warnings.push_back("Warning: " + counted(pairs.n, "pair", "pairs") +
                         " of boundary " + faces +
                         one_of_them(pairs,
                                     pairs.n == 1 ? " lies on each other"
                                                  : " lie on each other") +
                         "if it should not be, merge the nodes of the mesh.");
    const Seam<dim> nodes = nodes_on_faces(mesh);
    if (nodes.n > 0)
      warnings.push_back(
        "Warning: " + counted(nodes.n, "node", "nodes") + " of the boundary" +
        one_of_them(nodes,
                    (nodes.n == 1 ? " lies" : " lie") +
                      std::string(" on boundary ") + faces +
                      " of other cells between their corners") +
        "if it should not be, mesh the parts together, with the same nodes "
        "on both sides.");

    if (pairs.n > 0 || nodes.n > 0)
      return warnings;
    std::vector<unsigned int> part_of_cell;
    const unsigned int        n_parts = find_parts(mesh, part_of_cell);
    if (n_parts > 1)
      warnings.push_back(
        "Warning: the body consists of " + std::to_string(n_parts) +
        " parts that have no " + (dim == 2 ? "edge" : "face") +
        " in common; nothing keeps one from going through another.");
    return warnings;
  }



  template <int dim>
  std::vector<std::string>
  warnings_about_edges(const Triangulation<dim> &mesh, const Scene<dim> &scene)
  {
    std::vector<std::string> warnings;
    const FE_Q<dim>          element(1);
    FEFaceValues<dim>        values(
      element, QMidpoint<dim - 1>(), update_normal_vectors);
    std::map<unsigned int, std::vector<Tensor<1, dim>>> normals;
    std::map<unsigned int, Point<dim>>                  points;
    for (const auto &cell : mesh.cell_iterators_on_level(0))
      for (const unsigned int f : cell->face_indices())
        if (cell->at_boundary(f) &&
            scene.contact_on(cell->face(f)->boundary_id()) != nullptr)
          {
            values.reinit(cell, f);
            for (const unsigned int v : cell->face(f)->vertex_indices())
              {
                const unsigned int vertex = cell->face(f)->vertex_index(v);
                normals[vertex].push_back(values.normal_vector(0));
                points[vertex] = cell->face(f)->vertex(v);
              }
          }
    double     angle = 0;
    Point<dim> where;
    for (const auto &[vertex, list] : normals)
      for (const auto &a : list)
        {
          const double here = angle_between(a, list.front());
          if (here < smallest_corner && here > angle)
            {
              angle = here;
              where = points[vertex];
            }
        }
    if (angle > smallest_edge)
      warnings.push_back("Warning: the contact boundary is that of the mesh "
                         "file, with edges of up to " +
                         number(angle) + " degrees, one of them at " +
                         coordinates(where) +
                         ", which stay however fine the mesh, and where the "
                         "contact stress has peaks; if the boundary is meant "
                         "to be smooth there, take a finer mesh file, whose "
                         "edges are flatter.");
    return warnings;
  }



  template std::vector<std::string>
  warnings_about_cuts(const Triangulation<2> &);
  template std::vector<std::string>
  warnings_about_cuts(const Triangulation<3> &);
  template std::vector<std::string>
  warnings_about_edges(const Triangulation<2> &, const Scene<2> &);
  template std::vector<std::string>
  warnings_about_edges(const Triangulation<3> &, const Scene<3> &);
} // namespace Friction
