#ifndef friction_tests_benchmarks_contest_h
#define friction_tests_benchmarks_contest_h

#include <common/algorithms/nested_iteration.h>

#include <tests/benchmarks/baselines/report.h>
#include <tests/support/discretized.h>

#include <limits>
#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace Benchmark
{
  using namespace Tests;

  /** The names of all solvers: variants of the product and what to compare
   * with. */
  const std::vector<std::string> &solver_names();

  /** What a solver has achieved. */
  struct Result
  {
    bool         converged        = false; ///< certificate at most 1e-6
    unsigned int n_contact        = 0;
    unsigned int n_sticking       = 0;
    unsigned int iterations       = 0;
    unsigned int inner_iterations = 0;

    /// Set-up: everything between the assembled matrix and the first iteration.
    double setup_seconds = 0, solve_seconds = 0;

    /// The product's safeguards: how many attempts were made, and the name of
    /// the last one if there were several.
    unsigned int n_attempts = 1;
    std::string  attempt;

    /// Why a solver has stopped, if it has said so.
    std::string failure;

    std::size_t memory      = 0; ///< of the solver, without the matrix
    double      certificate = 0; ///< its largest number
    double      energy      = 0;
  };



  /**
   * Lets solvers solve the same discrete problem from the same initial guess:
   * that of the present level of a nested iteration, of which the product's
   * solution is known. The linear solvers solve the problem that remains when
   * all nodes in contact are bonded at that solution.
   */
  template <int dim>
  class Contest
  {
  public:
    /**
     * @param n_coarser  number of degrees of freedom on the level before; zero
     *                   if there is none.
     * @param seconds    time after which Gauss-Seidel is stopped.
     * @param limit      time after which any solver is stopped, and has failed.
     * @param first      what the default begins with, as it would in a run:
     * what the mesh before has taught.
     */
    Contest(NestedIteration<dim> &nest,
            const double          n_coarser,
            const double          seconds,
            const double          limit = std::numeric_limits<double>::max(),
            const Method          first = Method::algorithm);

    /** From now on errors are written to @p out after each iteration, compared
     * with a solution that is computed now. */
    void keep_history(std::ostream &out);

    /** Runs a solver. One that fails is not an error, but said on std::cerr. */
    Result run(const std::string &name);

    /** The solution of the last run. */
    const VectorType &
    solution() const
    {
      return u;
    }

    /** The contact problem, and the linear one. */
    DiscreteProblem<dim> problem() const;
    DiscreteProblem<dim> bonded_problem() const;

  private:
    class Recorder;

    NestedIteration<dim>         &nest;
    const double                  n_coarser, seconds, limit;
    const Method                  first;
    const std::vector<Point<dim>> points;
    NodalConstraints<dim>         bonded;
    const ContactBoundary<dim>    nothing;
    VectorType                    u;
    ContactState                  state   = ContactState(0, false);
    std::ostream                 *history = nullptr;
    std::map<bool, VectorType>    references; // is it linear?

    SolverSettings settings_of(const std::string &name) const;
    BaselineReport run(const std::string          &name,
                       const DiscreteProblem<dim> &problem,
                       Recorder                   &recorder);
    BaselineReport run_product(const SolverSettings       &settings,
                               const DiscreteProblem<dim> &problem,
                               Recorder                   &recorder);
    VectorType     reference(const DiscreteProblem<dim> &problem);
    void           start(const DiscreteProblem<dim> &problem);
    Result         judge(const DiscreteProblem<dim> &problem) const;
  };
} // namespace Benchmark

#endif
