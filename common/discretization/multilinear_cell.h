#ifndef friction_discretization_multilinear_cell_h
#define friction_discretization_multilinear_cell_h

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <deal.II/fe/mapping.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/**
 * Q1 elements by hand: what the mesh and a displacement are in a cell, both of
 * which are linear in each coordinate of the unit cell. Derivatives at a point
 * follow from the values in the cell's corners by some dozens of products.
 * FEValues would compute them through all shape functions of an FESystem, and
 * tables of their derivatives for each cell and face before, which takes
 * several times as long.
 */
namespace Friction::Multilinear
{
  using namespace dealii;

  /// Which side of the unit cell a corner is on, in one direction: 0 or 1.
  inline unsigned int
  side_of_corner(const unsigned int corner, const unsigned int direction)
  {
    return (corner >> direction) & 1U;
  }



  /// The hat functions of the corners of the unit interval, square or cube.
  template <int dim>
  std::array<double, GeometryInfo<dim>::vertices_per_cell>
  hat_values(const Point<dim> &p)
  {
    std::array<double, GeometryInfo<dim>::vertices_per_cell> values;
    for (unsigned int v = 0; v < values.size(); ++v)
      {
        values[v] = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          values[v] *= side_of_corner(v, d) == 1 ? p[d] : 1. - p[d];
      }
    return values;
  }



  /// The derivatives of hat_values() by one of the unit coordinates.
  template <int dim>
  std::array<double, GeometryInfo<dim>::vertices_per_cell>
  hat_derivatives(const Point<dim> &p, const unsigned int direction)
  {
    std::array<double, GeometryInfo<dim>::vertices_per_cell> derivatives;
    for (unsigned int v = 0; v < derivatives.size(); ++v)
      {
        derivatives[v] = side_of_corner(v, direction) == 1 ? 1. : -1.;
        for (unsigned int d = 0; d < dim; ++d)
          if (d != direction)
            derivatives[v] *= side_of_corner(v, d) == 1 ? p[d] : 1. - p[d];
      }
    return derivatives;
  }



  /// The coordinates of a point but for that of one direction.
  template <int dim>
  Point<dim - 1>
  without(const Point<dim> &p, const unsigned int direction)
  {
    Point<dim - 1> rest;
    for (unsigned int d = 0, e = 0; d < dim; ++d)
      if (d != direction)
        rest[e++] = p[d];
    return rest;
  }



  /// The corners of a face of a cell, in the order of deal.II's standard
  /// orientation.
  template <int dim>
  std::array<unsigned int, GeometryInfo<dim>::vertices_per_face>
  corners_of_face(const unsigned int f)
  {
    std::array<unsigned int, GeometryInfo<dim>::vertices_per_face> corners;
    for (unsigned int v = 0, k = 0; v < GeometryInfo<dim>::vertices_per_cell;
         ++v)
      if (side_of_corner(v, f / 2) == f % 2)
        corners[k++] = v;
    return corners;
  }



  /// A cell and the displacement in it.
  template <int dim>
  struct CellValues
  {
    static constexpr unsigned int n_corners =
      GeometryInfo<dim>::vertices_per_cell;
    static constexpr unsigned int n_edges = n_corners / 2;

    /// Coordinates of a place and, behind them, a displacement.
    using Values = std::array<double, 2 * dim>;

    explicit CellValues(const std::array<Values, n_corners> &corners)
      : corners(corners)
    {
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int v = 0, e = 0; v < n_corners; ++v)
          if (side_of_corner(v, d) == 0)
            {
              for (unsigned int c = 0; c < 2 * dim; ++c)
                edges[d][e][c] = corners[v + (1U << d)][c] - corners[v][c];
              ++e;
            }
    }

    /// Where a corner is.
    Point<dim>
    place(const unsigned int corner) const
    {
      Point<dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = corners[corner][d];
      return result;
    }

    /// The distance between two corners.
    double
    distance(const unsigned int corner, const unsigned int other) const
    {
      double square = 0.;
      for (unsigned int c = 0; c < dim; ++c)
        square += (corners[corner][c] - corners[other][c]) *
          (corners[corner][c] - corners[other][c]);
      return std::sqrt(square);
    }

    /// The longest line between opposite corners.
    double
    diameter() const
    {
      double longest = 0.;
      for (unsigned int v = 0; v < n_corners / 2; ++v)
        longest = std::max(longest, distance(v, n_corners - 1 - v));
      return longest;
    }

    /// The same of a face of the cell.
    double
    diameter_of_face(const unsigned int f) const
    {
      const auto of_face = corners_of_face<dim>(f);
      double     longest = 0.;
      for (unsigned int k = 0; k < of_face.size() / 2; ++k)
        longest =
          std::max(longest, distance(of_face[k], *(of_face.rbegin() + k)));
      return longest;
    }

    /// The least height of the parallelogram or parallelepiped that has the
    /// means of the edges as its own: how far away a side is from the other.
    double
    width() const
    {
      std::array<Tensor<1, dim>, dim> means;
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int e = 0; e < n_edges; ++e)
          for (unsigned int c = 0; c < dim; ++c)
            means[d][c] += edges[d][e][c] / n_edges;
      double volume, largest_base = 0.;
      if constexpr (dim == 2)
        {
          volume = cross_product_2d(means[0]) * means[1];
          for (const Tensor<1, dim> &mean : means)
            largest_base = std::max(largest_base, mean.norm());
        }
      else
        {
          volume = cross_product_3d(means[0], means[1]) * means[2];
          for (unsigned int d = 0; d < dim; ++d)
            largest_base =
              std::max(largest_base,
                       cross_product_3d(means[d], means[(d + 1) % dim]).norm());
        }
      return std::abs(volume) / largest_base;
    }

    /// In deal.II's order.
    std::array<Values, n_corners> corners;

    /// By how much they differ between the ends of the edges in each direction
    /// of the unit cell; these have the order of the corners they begin in.
    std::array<std::array<Values, n_edges>, dim> edges;
  };



  /// The values of a cell, with its corners as a mapping has them and a
  /// displacement that is known at its nodes.
  template <int dim, typename CellIterator, typename VectorType>
  CellValues<dim>
  cell_values(const Mapping<dim> &mapping,
              const CellIterator &cell,
              const VectorType   &displacement)
  {
    std::array<typename CellValues<dim>::Values, CellValues<dim>::n_corners>
               corners;
    const auto vertices = mapping.get_vertices(cell);
    for (unsigned int v = 0; v < CellValues<dim>::n_corners; ++v)
      for (unsigned int c = 0; c < dim; ++c)
        {
          corners[v][c]       = vertices[v][c];
          corners[v][dim + c] = displacement(cell->vertex_dof_index(v, c));
        }
    return CellValues<dim>(corners);
  }



  /// At a point of a cell: how the mesh maps the unit cell there, and the
  /// gradient of the displacement.
  ///
  /// What is trilinear has in each unit coordinate a derivative that is
  /// bilinear in the others, with the differences along the edges as values in
  /// the corners.
  template <int dim>
  struct PointOfCell
  {
    PointOfCell(const CellValues<dim> &cell, const Point<dim> &p)
    {
      std::array<Tensor<1, dim>, dim> tangents, derivatives;
      for (unsigned int d = 0; d < dim; ++d)
        {
          typename CellValues<dim>::Values sum{};
          const auto                       hats = hat_values(without(p, d));
          for (unsigned int e = 0; e < CellValues<dim>::n_edges; ++e)
            for (unsigned int c = 0; c < 2 * dim; ++c)
              sum[c] += hats[e] * cell.edges[d][e][c];
          for (unsigned int c = 0; c < dim; ++c)
            {
              tangents[d][c]    = sum[c];
              derivatives[d][c] = sum[dim + c];
            }
        }

      if constexpr (dim == 2)
        {
          unit_gradients[0] = cross_product_2d(tangents[1]);
          unit_gradients[1] = -cross_product_2d(tangents[0]);
        }
      else
        for (unsigned int d = 0; d < dim; ++d)
          unit_gradients[d] =
            cross_product_3d(tangents[(d + 1) % dim], tangents[(d + 2) % dim]);
      determinant        = unit_gradients[0] * tangents[0];
      const double scale = 1. / determinant;
      for (unsigned int d = 0; d < dim; ++d)
        unit_gradients[d] *= scale;

      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          for (unsigned int d = 0; d < dim; ++d)
            gradient[i][j] += derivatives[d][i] * unit_gradients[d][j];
    }

    /// How many times as large as the unit cell, signed.
    double determinant;

    /// Gradients of the unit coordinates, by those of the mesh.
    std::array<Tensor<1, dim>, dim> unit_gradients;

    /// Of the displacement, entry (i,j) its component i by coordinate j.
    Tensor<2, dim> gradient;
  };



  /// The middle of the unit cell.
  template <int dim>
  Point<dim>
  middle_of_cell()
  {
    Point<dim> middle;
    for (unsigned int d = 0; d < dim; ++d)
      middle[d] = 0.5;
    return middle;
  }



  /// A point of a face of the unit cell.
  template <int dim>
  Point<dim>
  point_of_face(const unsigned int f, const Point<dim - 1> &place)
  {
    Point<dim> p;
    for (unsigned int d = 0, e = 0; d < dim; ++d)
      p[d] = d == f / 2 ? f % 2 : place[e++];
    return p;
  }



  /// What a function that is linear in each coordinate has at a point, by the
  /// values there of the hat functions of the corners.
  template <typename T, std::size_t n>
  T
  interpolate(const std::array<double, n> &hats, const std::array<T, n> &values)
  {
    T sum = hats[0] * values[0];
    for (unsigned int k = 1; k < n; ++k)
      sum += hats[k] * values[k];
    return sum;
  }
} // namespace Friction::Multilinear

#endif
