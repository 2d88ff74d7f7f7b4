#ifndef friction_scene_coarse_cell_h
#define friction_scene_coarse_cell_h

#include <deal.II/base/array_view.h>
#include <deal.II/base/geometry_info.h>
#include <deal.II/base/point.h>

#include <deal.II/grid/tria.h>

#include <array>
#include <vector>

namespace Friction
{
  using namespace dealii;

  /**
   * What manifolds have in common that take the mean of points in the unit cell
   * of their coarse cell, RingManifold and ShellManifold.
   */
  namespace CoarseCell
  {
    /** The vertices of a side of a cell. */
    template <int dim>
    using Side = std::array<Point<dim>, GeometryInfo<dim>::vertices_per_face>;

    /** Calls @p f with the side opposite to each side with manifold id @p round
     * and that side itself, for the coarse cells of @p mesh with manifold id
     * @p id. Their vertices are in the same order. */
    template <int dim, typename Function>
    void
    for_each_between(const Triangulation<dim> &mesh,
                     const types::manifold_id  id,
                     const types::manifold_id  round,
                     const Function           &f)
    {
      using Info = GeometryInfo<dim>;
      for (const auto &cell : mesh.cell_iterators_on_level(0))
        if (cell->manifold_id() == id)
          for (const unsigned int face : cell->face_indices())
            if (cell->face(face)->manifold_id() == round)
              {
                // Faces 2k and 2k+1 are opposite to each other.
                Side<dim> inner, outer;
                for (unsigned int v = 0; v < inner.size(); ++v)
                  {
                    inner[v] =
                      cell->vertex(Info::face_to_cell_vertices(face ^ 1, v));
                    outer[v] =
                      cell->vertex(Info::face_to_cell_vertices(face, v));
                  }
                f(inner, outer);
              }
    }



    /**
     * The weighted mean of points of one of the cells, in any number, in the
     * unit cell. Cells are such that what is in the middle of some points of a
     * cell is in this cell, or on one of its sides if all of them are. Their
     * class has outside(), which is the larger the farther a point is from the
     * cell, pull_back() and push_forward().
     */
    template <int dim, typename Cell>
    Point<dim>
    mean(const std::vector<Cell>           &cells,
         const ArrayView<const Point<dim>> &points,
         const ArrayView<const double>     &weights)
    {
      Point<dim> middle;
      for (const Point<dim> &p : points)
        middle += p / double(points.size());
      const Cell *cell    = nullptr;
      double      outside = 0.;
      for (const Cell &candidate : cells)
        {
          const double distance = candidate.outside(middle);
          if (cell == nullptr || distance < outside)
            {
              cell    = &candidate;
              outside = distance;
            }
        }

      Point<dim> place;
      for (unsigned int i = 0; i < points.size(); ++i)
        place += weights[i] * cell->pull_back(points[i]);
      return cell->push_forward(place);
    }
  } // namespace CoarseCell
} // namespace Friction

#endif
