// Mean volumetric strains against the divergence theorem: the integral of the
// divergence over a quadrilateral is a sum over its edges, for which nothing of
// finite elements is needed. On cells of any shape.

#include <common/discretization/volumetric_strain.h>

#include <deal.II/base/mpi.h>

#include <Eigen/Dense>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

#include "../support/random_problem.h"

using namespace Tests;

namespace test_volumetric_strain
{
  struct Quadrilateral
  {
    double volume;

    /// Integrals over the cell of the two derivatives of each vertex' function.
    std::array<Tensor<1, 2>, 4> integrals;
  };

  // Along an edge a shape function is linear, and its integral is half of the
  // edge's length at both ends.
  Quadrilateral
  integrate(const typename DoFHandler<2>::active_cell_iterator &cell)
  {
    Quadrilateral                     result           = {};
    const std::array<unsigned int, 4> counterclockwise = {{0, 1, 3, 2}};
    for (unsigned int e = 0; e < 4; ++e)
      {
        const unsigned int a = counterclockwise[e],
                           b = counterclockwise[(e + 1) % 4];
        const Point<2>     p = cell->vertex(a), q = cell->vertex(b);
        const Tensor<1, 2> normal({q[1] - p[1], p[0] - q[0]});
        result.integrals[a] += .5 * normal;
        result.integrals[b] += .5 * normal;
        result.volume += .5 * (p[0] * q[1] - q[0] * p[1]);
      }
    return result;
  }



  Parameters
  parameters(const std::string &poisson_ratio, const std::string &strain)
  {
    return read_parameters(
      SCENES_DIR "/block.prm",
      {"Scene/Subdivisions=3,2",
       "Scene/Distortion=0.3",
       "Material/Young's modulus=" +
         std::to_string(2. * (1. + std::stod(poisson_ratio))),
       "Material/Poisson ratio=" + poisson_ratio,
       "Material/Volumetric strain=" + strain});
  }
} // namespace test_volumetric_strain

TEST(volumetric_strain)
{
  // Two bodies with shear modulus one on one distorted mesh, which differ by
  // the term with lambda.
  const Scene<2> scene(parameters("0.4999", "mean"));
  const Scene<2> without(parameters("0", "mean"));
  auto           mesh = make_triangulation<2>();
  scene.make_coarse_mesh(*mesh);
  mesh->refine_global(1);
  const Discretized<2>  d(scene, *mesh), d0(without, *mesh);
  const Eigen::MatrixXd got      = to_dense(d.stiffness().blocks());
  Eigen::MatrixXd       expected = to_dense(d0.stiffness().blocks());
  std::vector<types::global_dof_index> indices(8);
  for (const auto &cell : d.dof_handler().active_cell_iterators())
    {
      const Quadrilateral K = integrate(cell);
      cell->get_dof_indices(indices);
      for (unsigned int i = 0; i < 8; ++i)
        for (unsigned int j = 0; j < 8; ++j)
          expected(indices[i], indices[j]) +=
            scene.materials().base().lambda() * K.integrals[i / 2][i % 2] *
            K.integrals[j / 2][j % 2] / K.volume;
    }
  check_below((got - expected).cwiseAbs().maxCoeff() /
                expected.cwiseAbs().maxCoeff(),
              1e-13,
              "stiffness with mean volumetric strains");

  // Those of a displacement, for stresses.
  VectorType u(d.constraints().partitioner());
  Random     random(1);
  for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
    u.local_element(i) = random(-1., 1.);
  const Material averaged(1., .3, VolumetricStrain::mean),
    pointwise(1., .3, VolumetricStrain::pointwise);
  const VolumetricStrainField<2> field(
    d.mapping(), d.dof_handler(), averaged, u);
  double difference    = 0.;
  bool   is_divergence = true;
  for (const auto &cell : d.dof_handler().active_cell_iterators())
    {
      const Quadrilateral K      = integrate(cell);
      double              strain = 0.;
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int c = 0; c < 2; ++c)
          strain +=
            K.integrals[v][c] / K.volume * u(cell->vertex_dof_index(v, c));
      difference    = std::max(difference,
                            std::abs(field.value(cell, averaged, 7.) - strain));
      is_divergence = is_divergence && field.value(cell, pointwise, 7.) == 7.;
    }
  check_below(difference, 1e-12, "mean volumetric strain of a displacement");
  check(is_divergence, "the pointwise one is the divergence");
}
