#ifndef friction_algorithms_attempts_h
#define friction_algorithms_attempts_h

#include <common/algorithms/safeguarded_solver.h>

#include <limits>
#include <string>
#include <vector>

namespace Friction
{
  /** One call of SafeguardedSolver::solve(): what has been tried, and in which
   * order. How it is done says the solver. */
  template <int dim>
  class SafeguardedSolver<dim>::Attempts
  {
  public:
    Attempts(SafeguardedSolver<dim> &solver, const Search &search);

    SolverReport run();

  private:
    SafeguardedSolver<dim> &solver;
    const Search           &search;
    const bool              coulomb;
    const std::string       algorithm; // its name
    const Method            begin_with;
    const VectorType        initial;
    const ContactState      initial_state;

    // Of the last attempt, and what all of them have come to.
    SolverReport               report;
    std::vector<SolverAttempt> attempts;
    std::vector<CycleInfo>     cycles;

    // If nothing succeeds, what violates the law least is returned. Empty until
    // an attempt has failed with something finite.
    double       smallest_violation = std::numeric_limits<double>::infinity();
    VectorType   best;
    ContactState best_state;

    // What has been tried.
    bool is_condensed = false, is_aggregate = false, is_algebraic = false,
         is_pivoted = false, is_newton = false, is_continued = false,
         is_mixed = false, has_gone_on = false;

    // Whether there is anything left to do and to try it with. Notes that it is
    // being tried, and opens its share of the budget.
    bool begin(bool &is_tried, const bool is_last = false);

    template <typename MethodOfSolver>
    void attempt(const std::string &name, const MethodOfSolver &method);

    void start_anew();
    void start_from_best();

    // A step of Newton's method may have gone into the obstacle; phases that
    // Algorithm 3 alone has begun to find are a good guess.
    void start_anew_unless_guess_is_better();

    void try_algorithm(
      const unsigned int its_patience,
      const unsigned int worthwhile = std::numeric_limits<unsigned int>::max());

    void go_on_with_algorithm();
    void try_contact_nodes_alone();
    void try_aggregates();
    void try_algebraic_corrections();
    void try_pivoting(const bool others_have_failed);
    void try_newton();
    void try_continuation(const bool is_last);
    void try_mixed_algorithm_2(const bool is_last);

    // Newton's method and those that follow it are for contact nodes alone
    // where that is cheap.
    std::string where_newton_is() const;

    void try_what_knows_the_law();
    void try_what_has_solved_the_mesh_before();
  };
} // namespace Friction

#endif
