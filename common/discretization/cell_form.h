#ifndef friction_discretization_cell_form_h
#define friction_discretization_cell_form_h

#include <deal.II/base/tensor.h>

#include <deal.II/fe/fe_values.h>

#include <array>
#include <functional>

namespace Friction
{
  /**
   * The matrix of a cell, by pairs of vertices: the dim x dim block of two
   * vertices holds the bilinear form of the shape functions of the one (rows:
   * their components) and of the other (columns).
   */
  template <int dim>
  class CellBlocks
  {
  public:
    static constexpr unsigned int n_vertices = 1u << dim;

    dealii::Tensor<2, dim> &
    operator()(const unsigned int a, const unsigned int b)
    {
      return blocks[a * n_vertices + b];
    }

    const dealii::Tensor<2, dim> &
    operator()(const unsigned int a, const unsigned int b) const
    {
      return blocks[a * n_vertices + b];
    }

    CellBlocks &
    operator*=(const double factor)
    {
      for (dealii::Tensor<2, dim> &block : blocks)
        block *= factor;
      return *this;
    }

    void
    set_zero()
    {
      blocks.fill(dealii::Tensor<2, dim>());
    }

    /** Makes the matrix symmetric: blocks (b,a) with b < a are those of (a,b),
     * transposed. */
    void
    mirror()
    {
      for (unsigned int a = 0; a < n_vertices; ++a)
        for (unsigned int b = 0; b < a; ++b)
          (*this)(b, a) = transpose((*this)(a, b));
    }

  private:
    std::array<dealii::Tensor<2, dim>, n_vertices * n_vertices> blocks;
  };



  /**
   * Computes the matrix of a cell. FEValues is that of the cell and of the
   * scalar element FE_Q(1), one shape function per vertex, with gradients,
   * quadrature points and weights: the components of a displacement all have
   * the same shape functions. The blocks are zero. Only those of pairs (a,b)
   * with b <= a have to be computed, for the matrix is symmetric; others are
   * not looked at.
   */
  template <int dim>
  using CellForm =
    std::function<void(const dealii::FEValues<dim> &, CellBlocks<dim> &)>;
} // namespace Friction

#endif
