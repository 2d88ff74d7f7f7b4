#include <common/discretization/elasticity.h>
#include <common/discretization/volumetric_strain.h>

#include <deal.II/base/table.h>
#include <deal.II/base/tensor.h>

#include <deal.II/fe/fe.h>

#include <vector>

namespace Friction
{
  using namespace dealii;

  // With the gradients g_i of the scalar shape functions of components c_i an
  // entry is lambda theta_i theta_j + mu g_i[c_j] g_j[c_i]
  // + mu delta(c_i,c_j) g_i.g_j. What belongs to one shape function is asked
  // for once per quadrature point, and not for each pair, and the matrix is
  // symmetric.
  template <int dim>
  CellForm<dim>
  elasticity(const Material &material)
  {
    return [material](const FEValues<dim> &fe_values,
                      FullMatrix<double>  &cell_matrix) {
      struct Shape
      {
        unsigned int   component;
        Tensor<1, dim> gradient;
        double         theta;
      };
      const double       lambda = material.lambda(), mu = material.mu();
      const unsigned int n_dofs = fe_values.dofs_per_cell;
      Table<2, double>   theta;
      shape_volumetric_strains(fe_values, material, theta);
      std::vector<Shape> shapes(n_dofs);
      for (unsigned int i = 0; i < n_dofs; ++i)
        shapes[i].component =
          fe_values.get_fe().system_to_component_index(i).first;

      std::vector<double> sums(n_dofs * (n_dofs + 1) / 2, 0.);
      for (const unsigned int q : fe_values.quadrature_point_indices())
        {
          for (unsigned int i = 0; i < n_dofs; ++i)
            {
              shapes[i].gradient = fe_values.shape_grad(i, q);
              shapes[i].theta    = theta(i, q);
            }
          const double JxW   = fe_values.JxW(q);
          double      *entry = sums.data();
          for (auto i = shapes.begin(); i != shapes.end(); ++i)
            for (auto j = shapes.begin(); j <= i; ++j)
              *entry++ +=
                (lambda * i->theta * j->theta +
                 mu * i->gradient[j->component] * j->gradient[i->component] +
                 (i->component == j->component
                    ? mu * (i->gradient * j->gradient)
                    : 0.)) *
                JxW;
        }
      const double *entry = sums.data();
      for (unsigned int i = 0; i < n_dofs; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          cell_matrix(i, j) = cell_matrix(j, i) = *entry++;
    };
  }



  template CellForm<2> elasticity<2>(const Material &);
  template CellForm<3> elasticity<3>(const Material &);
} // namespace Friction
