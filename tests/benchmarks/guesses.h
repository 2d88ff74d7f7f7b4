#ifndef friction_tests_benchmarks_guesses_h
#define friction_tests_benchmarks_guesses_h

#include <common/algorithms/nested_iteration.h>
#include <common/input_error.h>

#include <tests/support/discretized.h>

#include <deal.II/grid/grid_tools.h>

#include <random>
#include <string>

namespace Benchmark
{
  using namespace Tests;

  /**
   * Replaces the initial guess of the present level by a bad one:
   *
   * - zero: no displacement, no normal forces;
   * - random: displacements of the size of the prescribed ones at every node;
   * - inside: the contact boundary lies a hundred times that deep in the
   *   obstacle, with normal stresses of a thousand times Young's modulus;
   * - lifted: the body is moved off by ten times that, and touches nowhere.
   *
   * NestedIteration::make_guess() makes it admissible, as it does with any
   * guess. If nothing but zero is prescribed, a thousandth of the body's size
   * takes its place.
   */
  template <int dim>
  void
  set_guess(NestedIteration<dim> &nest, const std::string &name)
  {
    const Discretization<dim> &d = nest.discretization();
    VectorType                 prescribed(d.constraints().partitioner());
    d.constraints().impose(prescribed);
    double size = prescribed.linfty_norm();
    if (!(size > 0))
      size = 1e-3 * GridTools::diameter(nest.mesh());

    VectorType &guess = *nest.guess()[0], &tractions = *nest.guess()[1];
    guess     = 0.;
    tractions = 0.;
    if (name == "random")
      {
        std::mt19937 random(1);
        for (unsigned int i = 0; i < guess.locally_owned_size(); ++i)
          guess.local_element(i) =
            size * (2. * random() / std::mt19937::max() - 1.);
      }
    else if (name == "inside")
      for (const ContactNode<dim> &node : d.contact())
        for (unsigned int c = 0; c < dim; ++c)
          {
            guess.local_element(dim * node.node + c) =
              100 * size * node.normal()[c];
            tractions.local_element(dim * node.node + c) = -1e3 *
              nest.parameters().material.youngs_modulus() * node.normal()[c];
          }
    else if (name == "lifted")
      {
        if (d.contact().size() > 0)
          for (unsigned int i = 0; i < guess.locally_owned_size(); ++i)
            guess.local_element(i) =
              -10 * size * d.contact()[0].normal()[i % dim];
      }
    else if (name != "zero")
      throw InputError("There is no guess '" + name +
                       "'. The guesses are: interpolated, zero, random, "
                       "inside, lifted.");
  }
} // namespace Benchmark

#endif
