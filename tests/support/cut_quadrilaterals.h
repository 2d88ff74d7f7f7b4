#ifndef friction_tests_support_cut_quadrilaterals_h
#define friction_tests_support_cut_quadrilaterals_h

#include <common/discretization/cell_form.h>
#include <common/parameters/material.h>

#include <Eigen/Dense>

namespace Tests
{
  /**
   * Linear elements on quadrilaterals that are cut into four triangles at their
   * centres. The centre of a cell has no neighbours outside, so it is
   * eliminated here: the solution in the vertices is that of the triangles,
   * which have 2 (V + F) degrees of freedom for V vertices and F cells.
   */
  inline Friction::CellForm<2>
  cut_quadrilaterals(const Friction::Material &material)
  {
    return [material](const dealii::FEValues<2> &fe_values,
                      Friction::CellBlocks<2>   &blocks) {
      const double lambda = material.lambda(), mu = material.mu();
      const auto   cell = fe_values.get_cell();
      Eigen::Matrix<double, 5, 2> points;
      points.row(4).setZero();
      for (unsigned int v = 0; v < 4; ++v)
        {
          points.row(v) << cell->vertex(v)[0], cell->vertex(v)[1];
          points.row(4) += points.row(v) / 4.;
        }

      // Vertices of the cell are numbered row by row.
      constexpr unsigned int triangles[4][3] = {
        {0, 1, 4}, {1, 3, 4}, {3, 2, 4}, {2, 0, 4}};
      Eigen::Matrix<double, 10, 10> A = Eigen::Matrix<double, 10, 10>::Zero();
      for (const auto &corners : triangles)
        {
          // The columns of the inverse are values and gradients of the
          // barycentric coordinates at the origin.
          Eigen::Matrix3d m;
          for (unsigned int i = 0; i < 3; ++i)
            m.row(i) << 1., points(corners[i], 0), points(corners[i], 1);
          const Eigen::Matrix3d coordinates = m.inverse();
          const double          area        = std::abs(m.determinant()) / 2.;
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = 0; j < 3; ++j)
              {
                const Eigen::Vector2d g = coordinates.block<2, 1>(1, i),
                                      h = coordinates.block<2, 1>(1, j);
                A.block<2, 2>(2 * corners[i], 2 * corners[j]) += area *
                  (lambda * g * h.transpose() + mu * h * g.transpose() +
                   mu * g.dot(h) * Eigen::Matrix2d::Identity());
              }
        }
      const Eigen::Matrix<double, 8, 8> condensed = A.topLeftCorner<8, 8>() -
        A.topRightCorner<8, 2>() * A.bottomRightCorner<2, 2>().inverse() *
          A.bottomLeftCorner<2, 8>();
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b <= a; ++b)
          for (unsigned int r = 0; r < 2; ++r)
            for (unsigned int c = 0; c < 2; ++c)
              blocks(a, b)[r][c] = condensed(2 * a + r, 2 * b + c);
    };
  }
} // namespace Tests

#endif
