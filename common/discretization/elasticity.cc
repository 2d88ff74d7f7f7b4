#include <common/discretization/elasticity.h>

#include <array>

namespace Friction
{
  using namespace dealii;

  // With the gradients g_a of the shape functions the block of the vertices a
  // and b is the integral of lambda g_a g_b^T + mu g_b g_a^T + mu (g_a.g_b) I.
  // All three follow from the integral G of g_a g_b^T, if lambda and mu are
  // constant in the cell: the second is its transpose, the third its trace.
  // This is a quarter of the work at each quadrature point. If the volumetric
  // strain is the mean over the cell, the first is the product of the integrals
  // of g_a and g_b, divided by the volume.
  template <int dim>
  CellForm<dim>
  elasticity(const Materials<dim> &materials)
  {
    return
      [materials](const FEValues<dim> &fe_values, CellBlocks<dim> &blocks) {
        const Material &material = materials.of(fe_values.get_cell());
        const double    lambda = material.lambda(), mu = material.mu();
        const bool      is_mean =
          material.volumetric_strain() == VolumetricStrain::mean;
        constexpr unsigned int n = CellBlocks<dim>::n_vertices;

        std::array<Tensor<1, dim>, n> gradients, integrals;
        double                        volume = 0.;
        for (const unsigned int q : fe_values.quadrature_point_indices())
          {
            const double JxW = fe_values.JxW(q);
            volume += JxW;
            for (unsigned int a = 0; a < n; ++a)
              {
                gradients[a]                  = fe_values.shape_grad(a, q);
                const Tensor<1, dim> weighted = gradients[a] * JxW;
                integrals[a] += weighted;
                for (unsigned int b = 0; b <= a; ++b)
                  for (unsigned int r = 0; r < dim; ++r)
                    for (unsigned int c = 0; c < dim; ++c)
                      blocks(a, b)[r][c] += weighted[r] * gradients[b][c];
              }
          }
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int b = 0; b <= a; ++b)
            {
              const Tensor<2, dim> G = blocks(a, b);
              blocks(a, b)           = mu * transpose(G) +
                (is_mean
                   ? lambda / volume * outer_product(integrals[a], integrals[b])
                   : lambda * G);
              for (unsigned int d = 0; d < dim; ++d)
                blocks(a, b)[d][d] += mu * trace(G);
            }
      };
  }



  template CellForm<2> elasticity<2>(const Materials<2> &);
  template CellForm<3> elasticity<3>(const Materials<3> &);
} // namespace Friction
