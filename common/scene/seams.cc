#include <common/scene/seams.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

namespace Friction
{
  namespace
  {
    // What is closer lies on each other, as a part of the shortest edge of the
    // mesh.
    constexpr double close = 1e-3;



    template <int dim>
    double
    shortest_edge(const Triangulation<dim> &mesh)
    {
      double shortest = std::numeric_limits<double>::max();
      for (const auto &cell : mesh.cell_iterators_on_level(0))
        for (unsigned int line = 0; line < cell->n_lines(); ++line)
          shortest = std::min(shortest, cell->line(line)->diameter());
      return shortest;
    }



    // The distance of a point from a triangle, or in two dimensions from a
    // segment, if the point lies before it; otherwise infinite.
    template <int dim>
    double
    distance_before(const Point<dim>                  &p,
                    const std::array<Point<dim>, dim> &corners)
    {
      // The coordinates c of the nearest point, from the normal equations.
      std::array<Tensor<1, dim>, dim - 1> edges;
      SymmetricTensor<2, dim - 1>         products;
      Tensor<1, dim - 1>                  right;
      const Tensor<1, dim>                from_corner = p - corners[0];
      for (unsigned int i = 0; i + 1 < dim; ++i)
        edges[i] = corners[i + 1] - corners[0];
      for (unsigned int i = 0; i + 1 < dim; ++i)
        {
          right[i] = edges[i] * from_corner;
          for (unsigned int j = 0; j <= i; ++j)
            products[i][j] = edges[i] * edges[j];
        }
      const double size = products[0][0] * products[dim - 2][dim - 2];
      if (!(determinant(products) > 1e-12 * (dim == 3 ? size : 0.)))
        return std::numeric_limits<double>::infinity();
      const Tensor<1, dim - 1> c    = invert(products) * right;
      double                   rest = 1;
      Tensor<1, dim>           off  = from_corner;
      for (unsigned int i = 0; i + 1 < dim; ++i)
        {
          if (c[i] < -close)
            return std::numeric_limits<double>::infinity();
          rest -= c[i];
          off -= c[i] * edges[i];
        }
      return rest < -close ? std::numeric_limits<double>::infinity()
                           : off.norm();
    }



    // Whether a point lies on a face, up to a distance, and in none of its
    // corners.
    template <int dim>
    bool
    lies_on(const Point<dim>              &p,
            const std::vector<Point<dim>> &face,
            const double                   near)
    {
      for (const Point<dim> &corner : face)
        if (p.distance(corner) < 2 * near)
          return false;
      std::array<Point<dim>, dim> half;
      std::copy_n(face.begin(), dim, half.begin());
      double distance = distance_before<dim>(p, half);
      if (dim == 3)
        {
          std::copy_n(face.begin() + 1, dim, half.begin());
          distance = std::min(distance, distance_before<dim>(p, half));
        }
      return distance < near;
    }
  } // namespace



  template <int dim>
  Seam<dim>
  faces_on_each_other(const Triangulation<dim> &mesh)
  {
    const double unit = close * shortest_edge(mesh);
    std::map<std::array<std::int64_t, dim>, unsigned int> faces;
    Seam<dim>                                             seam;
    for (const auto &cell : mesh.cell_iterators_on_level(0))
      for (const unsigned int f : cell->face_indices())
        if (cell->at_boundary(f))
          {
            const Point<dim>              center = cell->face(f)->center();
            std::array<std::int64_t, dim> key;
            for (unsigned int d = 0; d < dim; ++d)
              key[d] = std::llround(center[d] / unit);
            if (++faces[key] == 2)
              {
                ++seam.n;
                seam.where = center;
              }
          }
    return seam;
  }



  template <int dim>
  Seam<dim>
  nodes_on_faces(const Triangulation<dim> &mesh)
  {
    // Nodes are sorted along a direction in which hardly any mesh has many of
    // them side by side, so that for each face there are few to look at.
    Tensor<1, dim> along;
    for (unsigned int d = 0; d < dim; ++d)
      along[d] = std::sqrt(2. + 3. * d);
    std::map<unsigned int, Point<dim>>   vertices;
    std::vector<std::vector<Point<dim>>> faces;
    for (const auto &cell : mesh.cell_iterators_on_level(0))
      for (const unsigned int f : cell->face_indices())
        if (cell->at_boundary(f))
          {
            faces.emplace_back();
            for (const unsigned int v : cell->face(f)->vertex_indices())
              {
                vertices[cell->face(f)->vertex_index(v)] =
                  cell->face(f)->vertex(v);
                faces.back().push_back(cell->face(f)->vertex(v));
              }
          }
    std::vector<std::pair<double, Point<dim>>> sorted;
    for (const auto &[vertex, p] : vertices)
      sorted.emplace_back(along * Tensor<1, dim>(p), p);
    const auto is_before = [](const auto &a, const auto &b) {
      return a.first < b.first;
    };
    std::sort(sorted.begin(), sorted.end(), is_before);

    const double      near = close * shortest_edge(mesh);
    Seam<dim>         seam;
    std::vector<char> is_found(sorted.size(), 0);
    for (const std::vector<Point<dim>> &face : faces)
      {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Point<dim> &corner : face)
          {
            low  = std::min(low, along * Tensor<1, dim>(corner));
            high = std::max(high, along * Tensor<1, dim>(corner));
          }
        const double margin = near * along.norm();
        const auto   begin  = std::lower_bound(
          sorted.begin(),
          sorted.end(),
          std::pair<double, Point<dim>>(low - margin, Point<dim>()),
          is_before);
        for (auto p = begin; p != sorted.end() && p->first <= high + margin;
             ++p)
          if (!is_found[p - sorted.begin()] &&
              lies_on<dim>(p->second, face, near))
            {
              is_found[p - sorted.begin()] = 1;
              ++seam.n;
              seam.where = p->second;
            }
      }
    return seam;
  }



  template Seam<2> faces_on_each_other(const Triangulation<2> &);
  template Seam<3> faces_on_each_other(const Triangulation<3> &);
  template Seam<2> nodes_on_faces(const Triangulation<2> &);
  template Seam<3> nodes_on_faces(const Triangulation<3> &);
} // namespace Friction
