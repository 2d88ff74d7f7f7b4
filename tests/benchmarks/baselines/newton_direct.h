#ifndef friction_tests_benchmarks_newton_direct_h
#define friction_tests_benchmarks_newton_direct_h

#include <tests/benchmarks/baselines/coulomb_law.h>
#include <tests/benchmarks/baselines/report.h>
#include <tests/benchmarks/baselines/stiffness_factor.h>

#include <memory>
#include <vector>

namespace Benchmark
{
  /**
   * The semismooth Newton method for Coulomb friction, or primal-dual active
   * sets, with a direct solver: one sparse Cholesky factorisation of the
   * stiffness matrix, and then dense linear algebra on the Schur complement of
   * the contact nodes. In two dimensions nothing is known that is quicker.
   *
   * The dense block takes only nodes that may get into contact: those of the
   * initial guess, and some layers around them. If another one penetrates in
   * the end, the block grows and the matrix is factorised once more.
   */
  template <int dim>
  class NewtonDirect
  {
  public:
    static constexpr unsigned int maximum_steps = 60;

    /// Layers of nodes around the contact zone of the guess.
    static constexpr unsigned int n_layers = (dim == 2 ? 6 : 2);

    /** Factorises. The arguments are the initial guess. */
    NewtonDirect(const DiscreteProblem<dim> &problem,
                 const VectorType           &u,
                 const ContactState         &state);

    BaselineReport
    solve(VectorType &u, ContactState &state, const Watch &watch = {});

  private:
    // The state of the iteration: displacements and forces at the nodes of the
    // dense block, and what they mean.
    struct Iterate
    {
      std::vector<double>             x, r;
      std::vector<LinearizedLaw<dim>> laws;
      double                          violation = 0, largest_force = 0;
    };

    const RotatedProblem<dim>             rotated;
    const double                          F;
    std::vector<char>                     chosen;
    std::unique_ptr<StiffnessFactor<dim>> factor;
    std::vector<double>                   stiffness, b;

    void make_factor();
    void choose_neighbors(const unsigned int n_layers);

    NodeValue<dim> at_node(const std::vector<double> &values,
                           const unsigned int         i) const;

    void                evaluate(Iterate                   &iterate,
                                 const std::vector<double> *given_bounds = nullptr) const;
    std::vector<double> newton_step(const Iterate &iterate) const;
    bool                minimize(Iterate        &iterate,
                                 BaselineReport &report,
                                 const Watch    &watch) const;
    VectorType          displacement(const std::vector<double> &x) const;
    unsigned int        choose_penetrating(const VectorType &u);
  };
} // namespace Benchmark

#endif
