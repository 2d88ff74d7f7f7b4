#ifndef friction_algorithms_coulomb_solver_h
#define friction_algorithms_coulomb_solver_h

#include <common/contact/certificate.h>
#include <common/parallel/phase_costs.h>
#include <common/iteration/monotone_multigrid.h>

#include <string>
#include <vector>

namespace Friction
{
  /** One of several attempts at the same problem. */
  struct SolverAttempt
  {
    std::string  name; ///< of the method, for a message
    unsigned int cycles      = 0;
    bool         converged   = false;
    double       certificate = 0; ///< its largest violation
  };



  /** How the solution of a contact problem with friction went. */
  struct SolverReport
  {
    bool converged = false;

    /// Whether the last multigrid solution has converged, whatever the outer
    /// iteration and the certificate say.
    bool inner_converged = false;

    /// Multigrid solutions with given normal forces: those of Algorithm 2, one
    /// otherwise.
    unsigned int outer_iterations = 0;

    /// All multigrid cycles, of all outer iterations.
    std::vector<CycleInfo> cycles;

    /// Mean contraction of the increments per cycle (Algorithm 2: in the first
    /// outer iteration).
    double contraction = 0;

    /// Energy norm of the error of the iteration, see MultigridResult; without
    /// what the outer iteration of Algorithm 2 adds to it.
    double algebraic_error = 0;

    /// What SafeguardedSolver has tried, in this order; empty if the first
    /// attempt was enough.
    std::vector<SolverAttempt> attempts;

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

    /// What this process has spent on the solution, by phase.
    PhaseCosts costs;

    /// Bytes on this process: of the leaf matrix, and of smoother, level
    /// matrices and vectors of the levels.
    std::size_t matrix_memory = 0;
    std::size_t solver_memory = 0;

    /// The energy of the solution, and its residual f - A u at all nodes.
    double     energy = 0;
    VectorType residual;
  };



  /**
   * The largest force that the displacement of a single node would cause,
   * reduced to what is left of it where rounding errors are all there is.
   * Smaller forces certify nothing; see make_certificate().
   */
  template <int dim>
  double force_of_rounding(const DiscreteProblem<dim> &problem,
                           const VectorType           &u);



  /**
   * Solves the discrete contact problem with the law of friction it has.
   *
   * Without friction, and with given friction bounds (Tresca), the monotone
   * multigrid iteration does it. Coulomb's law ties the bounds to the normal
   * forces of the solution itself:
   * - Algorithm 2 iterates (6.11): solve with given normal forces, take those
   *   of the solution, and so on until they no longer change.
   * - Algorithm 3 lets the leading relaxation use the normal forces of the
   *   intermediate iterate, and needs no outer iteration.
   */
  template <int dim>
  class CoulombSolver
  {
  public:
    using Progress = typename MonotoneMultigrid<dim>::Progress;

    /** As for MonotoneMultigrid. */
    CoulombSolver(const LevelHierarchy<dim>  &hierarchy,
                  const DiscreteProblem<dim> &problem,
                  const SolverSettings       &settings);

    /**
     * Solves, and certifies the solution.
     * @param u      admissible initial guess, and solution.
     * @param state  the same; with the law of Tresca its normal forces are the
     *               given ones.
     */
    SolverReport
    solve(VectorType &u, ContactState &state, const Progress &progress = {});

    /**
     * Fills in what the report says of the solution itself, as opposed to how
     * it was found: residual, energy and certificate.
     * @param u  has its ghosts brought up to date. Collective.
     */
    void certify(SolverReport       &report,
                 VectorType         &u,
                 const ContactState &state) const;

    const MonotoneMultigrid<dim> &
    multigrid() const
    {
      return iteration;
    }

  private:
    const DiscreteProblem<dim> problem;
    const SolverSettings       settings;
    MonotoneMultigrid<dim>     iteration;

    void iterate_normal_forces(SolverReport   &report,
                               VectorType     &u,
                               ContactState   &state,
                               const Progress &progress);
  };
} // namespace Friction

#endif
