#include <common/dense_algebra.h>
#include <common/nodes/strong_planes.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace Friction
{
  namespace
  {
    // What a strong coupling has of the strongest one; and what all couplings
    // in the plane of a node have of its diagonal together, or what strong ones
    // have, by which nodes in planes are told quickly.
    constexpr double least_strength = .35, share_of_diagonal = .85,
                     strong_share = .75;

    // Of squares of cosines, weighted by strengths: what may stand out of the
    // plane of a node. And the largest sine of a coupling of the plane.
    constexpr double largest_variance = .05, largest_sine = .35;

    template <int dim>
    double
    strength(const NodeBlockMatrix<dim> &A,
             const unsigned int          row,
             const std::size_t           position)
    {
      return -A.trace_of(row, position);
    }



    // What a coupling of this row has to have in its opinion.
    template <int dim>
    double
    weakest_of(const NodeBlockMatrix<dim> &A, const unsigned int row)
    {
      double strongest = 0.;
      for (std::size_t e = A.row_begin(row) + 1; e < A.row_end(row); ++e)
        strongest = std::max(strongest, strength(A, row, e));
      return least_strength * strongest;
    }



    Eigen::Vector3d
    unit_direction(const Place &from, const Place &to)
    {
      return Eigen::Vector3d(to[0] - from[0], to[1] - from[1], to[2] - from[2])
        .normalized();
    }



    // Whether all eigenvalues of a symmetric matrix do: it is positive definite
    // without that much on its diagonal. Most nodes that are in no plane are
    // done with here, in no time.
    bool
    exceed(const Eigen::Matrix3d &matrix, const double bound)
    {
      const Eigen::Matrix3d rest = matrix - bound * Eigen::Matrix3d::Identity();
      return rest(0, 0) > 0. &&
        rest(0, 0) * rest(1, 1) > rest(0, 1) * rest(0, 1) &&
        rest.determinant() > 0.;
    }



    bool
    is_flat(const Eigen::Vector3d &normal, const Eigen::Vector3d &direction)
    {
      return std::abs(direction.dot(normal)) <= largest_sine;
    }



    // Whether few couplings of a node are strong and have most of its diagonal.
    template <int dim, typename IsStrong>
    bool
    has_few_strong(const NodeBlockMatrix<dim> &A,
                   const unsigned int          row,
                   const IsStrong             &is_strong)
    {
      if (A.is_empty(row))
        return false;
      std::size_t n   = 0;
      double      sum = 0.;
      for (std::size_t e = A.row_begin(row) + 1; e < A.row_end(row); ++e)
        if (is_strong(e))
          {
            ++n;
            sum += strength(A, row, e);
          }
      return n > 0 && 2 * n < A.row_end(row) - A.row_begin(row) &&
        sum >= strong_share * trace<dim>(A.diagonal(row));
    }



    // Whether a node of few strong couplings is in a plane, and the normal of
    // this plane.
    template <int dim, typename IsStrong>
    bool
    find_normal(const NodeBlockMatrix<dim> &A,
                const unsigned int          row,
                const IsStrong             &is_strong,
                const Places               &positions,
                Eigen::Vector3d            &normal)
    {
      const auto direction = [&](const std::size_t e) {
        return unit_direction(positions[row], positions[A.column(e)]);
      };
      Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
      for (std::size_t e = A.row_begin(row) + 1; e < A.row_end(row); ++e)
        if (is_strong(e) && A.column(e) < A.n_rows())
          {
            const Eigen::Vector3d d = direction(e);
            moment += strength(A, row, e) * d * d.transpose();
          }
      if (exceed(moment, largest_variance * moment.trace()))
        return false;
      normal = eigenpairs(moment).vectors.col(0);

      double in_plane = 0.;
      for (std::size_t e = A.row_begin(row) + 1; e < A.row_end(row); ++e)
        if (strength(A, row, e) > 0. &&
            (A.column(e) >= A.n_rows() ? is_strong(e)
                                       : is_flat(normal, direction(e))))
          in_plane += strength(A, row, e);
      return in_plane >= share_of_diagonal * trace<dim>(A.diagonal(row));
    }



    // The same if only this node is asked which of its couplings are strong.
    template <int dim>
    bool
    find_normal(const NodeBlockMatrix<dim> &A,
                const unsigned int          row,
                const Places               &positions,
                Eigen::Vector3d            &normal)
    {
      const double weakest   = weakest_of(A, row);
      const auto   is_strong = [&](const std::size_t e) {
        return strength(A, row, e) >= weakest;
      };
      return weakest > 0. && has_few_strong(A, row, is_strong) &&
        find_normal(A, row, is_strong, positions, normal);
    }
  } // namespace



  template <int dim>
  bool
  may_be_in_plane(const NodeBlockMatrix<dim> &A, const unsigned int row)
  {
    const double weakest = weakest_of(A, row);
    return weakest > 0. && has_few_strong(A, row, [&](const std::size_t e) {
             return strength(A, row, e) >= weakest;
           });
  }



  template <int dim>
  bool
  may_be_in_plane(const NodeBlockMatrix<dim> &A,
                  const unsigned int          row,
                  const Places               &positions)
  {
    Eigen::Vector3d normal;
    if (!find_normal(A, row, positions, normal))
      return false;
    const double weakest = weakest_of(A, row);
    for (std::size_t e = A.row_begin(row) + 1; e < A.row_end(row); ++e)
      {
        const unsigned int j = A.column(e);
        Eigen::Vector3d    another;
        if (j < A.n_rows() && strength(A, row, e) >= weakest &&
            is_flat(normal, unit_direction(positions[row], positions[j])) &&
            find_normal(A, j, positions, another))
          return true;
      }
    return false;
  }



  template <int dim>
  std::vector<std::vector<unsigned int>>
  strong_planes(const NodeBlockMatrix<dim> &A,
                const std::vector<char>    &is_relaxed,
                const Places               &positions)
  {
    const unsigned int  n = A.n_rows();
    std::vector<double> weakest(n);
    for (unsigned int i = 0; i < n; ++i)
      weakest[i] = weakest_of(A, i);
    // Of couplings to nodes of other processes the row's opinion has to do.
    const auto is_strong = [&](const unsigned int i, const std::size_t e) {
      const unsigned int j = A.column(e);
      return weakest[i] > 0. && strength(A, i, e) >= weakest[i] &&
        (j >= n || strength(A, i, e) >= weakest[j]);
    };

    std::vector<char>            is_left(n, false);
    std::vector<Eigen::Vector3d> normals(n);
    for (unsigned int i = 0; i < n; ++i)
      {
        const auto is_strong_here = [&](const std::size_t e) {
          return is_strong(i, e);
        };
        is_left[i] = is_relaxed[i] && has_few_strong(A, i, is_strong_here) &&
          find_normal(A, i, is_strong_here, positions, normals[i]);
      }

    std::vector<std::vector<unsigned int>> planes;
    for (unsigned int first = 0; first < n; ++first)
      if (is_left[first])
        {
          std::vector<unsigned int> plane(1, first);
          is_left[first] = false;
          for (unsigned int k = 0; k < plane.size(); ++k)
            {
              const unsigned int i = plane[k];
              for (std::size_t e = A.row_begin(i) + 1; e < A.row_end(i); ++e)
                {
                  const unsigned int j = A.column(e);
                  if (j >= n || !is_left[j] || !is_strong(i, e))
                    continue;
                  const Eigen::Vector3d d =
                    unit_direction(positions[i], positions[j]);
                  if (is_flat(normals[i], d) && is_flat(normals[j], d))
                    {
                      is_left[j] = false;
                      plane.push_back(j);
                    }
                }
            }
          std::sort(plane.begin(), plane.end());
          planes.push_back(std::move(plane));
        }
    return planes;
  }



  template std::vector<std::vector<unsigned int>> strong_planes(
    const NodeBlockMatrix<2> &, const std::vector<char> &, const Places &);
  template std::vector<std::vector<unsigned int>> strong_planes(
    const NodeBlockMatrix<3> &, const std::vector<char> &, const Places &);
  template bool may_be_in_plane(const NodeBlockMatrix<2> &, const unsigned int);
  template bool may_be_in_plane(const NodeBlockMatrix<3> &, const unsigned int);
  template bool may_be_in_plane(const NodeBlockMatrix<2> &,
                                const unsigned int,
                                const Places &);
  template bool may_be_in_plane(const NodeBlockMatrix<3> &,
                                const unsigned int,
                                const Places &);
} // namespace Friction
