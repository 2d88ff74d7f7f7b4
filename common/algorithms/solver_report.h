#ifndef friction_algorithms_solver_report_h
#define friction_algorithms_solver_report_h

#include <common/algorithms/multigrid_loop.h>
#include <common/contact/certificate.h>
#include <common/parallel/phase_costs.h>

#include <string>
#include <vector>

namespace Friction
{
  /** What a mesh is solved with, as far as that is known beforehand. */
  enum class Method : unsigned int
  {
    algorithm,    ///< that of the settings
    newton,       ///< NewtonSolver, or pivoting
    algebraic,    ///< that of the settings with AlgebraicCorrection
    aggregates,   ///< that of the settings with AggregateCorrection
    contact_nodes ///< that of the settings on contact nodes alone
  };



  /** One of several attempts at the same problem, see SafeguardedSolver. */
  struct SolverAttempt
  {
    std::string  name; ///< of the method, for a message
    unsigned int cycles    = 0;
    bool         converged = false;
  };



  /** How the solution of a contact problem with friction went. */
  struct SolverReport
  {
    bool converged = false;

    /// Whether the last multigrid solution has converged, whatever the outer
    /// iteration and the certificate say.
    bool inner_converged = false;

    /// Multigrid solutions with given normal forces: those of Algorithm 2,
    /// otherwise one for each position of a platen; those of the last attempt.
    unsigned int outer_iterations = 0;

    /// All multigrid cycles, of all outer iterations.
    std::vector<CycleInfo> cycles;

    /// Mean contraction of the increments per cycle (Algorithm 2: in the first
    /// outer iteration). Zero if there was but one.
    double contraction = 0;

    /// The same if these were cycles of an iteration of the whole body, and
    /// zero if they were steps of Newton's method or on contact nodes alone:
    /// what the next mesh may expect.
    double pace = 0;

    /// Energy norm of the error of the iteration, see MultigridResult; without
    /// what the outer iteration of Algorithm 2 adds to it.
    double algebraic_error = 0;

    /// Whether Newton's method was the end of another one, see NewtonFinish;
    /// contraction is that of the other one then.
    bool finished_by_newton = false;

    /// What SafeguardedSolver has tried, in this order; empty if the algorithm
    /// of the settings was tried first and was enough by itself.
    std::vector<SolverAttempt> attempts;

    /// What the next mesh may begin with, to judge by this one.
    Method next_method = Method::algorithm;

    /// Algorithm 2: the relative change of the normal forces in each outer
    /// iteration.
    std::vector<double> outer_changes;

    /// $\rho_\tau$ as printed in the thesis: the geometric mean of the relative
    /// changes. Zero if there are none.
    double rho_tau_as_printed() const;

    /// The mean contraction of the relative changes per outer iteration, which
    /// is what the tabulated numbers fit. Zero if there are fewer than two.
    double rho_tau_contraction() const;

    Certificate certificate;

    /// What this process has spent on the solution, by phase; counted by
    /// CoulombSolver and SafeguardedSolver.
    PhaseCosts costs{};

    /// Bytes on this process, of smoother and correction.
    std::size_t solver_memory = 0;

    /// The energy of the solution, and its residual f - A u at all nodes.
    double     energy = 0;
    VectorType residual;

    /// Takes over what a single multigrid iteration, or a solution by Newton's
    /// method, has come to.
    void set_result(const MultigridResult &result);

    /// Adds what an earlier solution has taken which led to this one: cycles,
    /// outer iterations and attempts. Contraction, errors and changes remain
    /// those of this one.
    void add_earlier(const SolverReport &report);
  };
} // namespace Friction

#endif
