#ifndef friction_parameters_solver_settings_h
#define friction_parameters_solver_settings_h

#include <common/parameters/material.h>

namespace Friction
{
  /**
   * How normal and tangential contact forces are tied together.
   */
  enum class FrictionLaw
  {
    none,   ///< frictionless: nothing of friction is allocated or computed
    tresca, ///< the normal forces in the friction bound are given
    coulomb ///< the normal forces in the friction bound are those of the
            ///< solution
  };

  /**
   * How the normal forces of Coulomb's law are found.
   */
  enum class Algorithm
  {
    fixed_point,      ///< Algorithm 2: an outer iteration over Tresca problems
    gauss_seidel_like ///< Algorithm 3: updated inside the leading relaxation
  };

  enum class CoarseCorrection
  {
    truncated,  ///< unconstrained on truncated functions, then a line search
    monotone,   ///< constrained by coarse obstacles, without a line search
    aggregates, ///< as truncated, and once more on levels made of the matrix
    algebraic   ///< the truncated problem solved on the leaf mesh itself
  };

  enum class Cycle
  {
    V,
    W
  };

  /**
   * How the coarsest level is solved.
   */
  enum class CoarsestMethod
  {
    automatic,          ///< whichever is quicker for its size and shape
    direct,             ///< by a sparse factorisation
    algebraic_multigrid ///< by conjugate gradients with algebraic multigrid
  };

  /**
   * Where the problem is solved on contact nodes alone, see CondensedSolver.
   */
  enum class CondensationUse
  {
    never,
    where_cycles_are_many, ///< for a known reason, or because others have
                           ///< failed
    where_quicker          ///< there, and on small meshes
  };

  enum class TruncationVariant
  {
    phases,                     ///< stick: all components; slip: the normal one
    contact,                    ///< all components of every node in contact
    phases_without_second_order ///< phases, but no second derivative of
                                ///< friction
  };

  /**
   * How the direction of slip is found in the local problems of three
   * dimensions; in two there are but two directions to choose from.
   */
  enum class LocalSolver
  {
    secular_equation, ///< one scalar equation for the direction of slip
    uzawa             ///< the thesis's iteration for the tangential force
  };

  /**
   * What a scene file may choose about the solver. It is read where parts are
   * made and put together, as in make_correction(); a part itself is told what
   * it has to know, and nothing else.
   */
  struct SolverSettings
  {
    Algorithm         algorithm         = Algorithm::gauss_seidel_like;
    CoarseCorrection  coarse_correction = CoarseCorrection::truncated;
    Cycle             cycle             = Cycle::V;
    TruncationVariant truncation        = TruncationVariant::phases;
    LocalSolver       local_solver      = LocalSolver::secular_equation;
    CoarsestMethod    coarsest_method   = CoarsestMethod::automatic;

    /// Relaxation sweeps on the leaf mesh before and after the coarse
    /// correction.
    unsigned int smoothing_steps = 3;

    /// The same on the correction levels.
    unsigned int coarse_smoothing_steps = 6;

    /// Relative increment at which the multigrid iteration stops.
    double inner_tolerance = 1e-9;

    /// Whether to stop Algorithm 3 as soon as its error is small compared with
    /// that of the discretisation. DiscretizationStop computes the error at
    /// which to stop, an energy norm; zero: only the inner tolerance counts.
    bool   stop_at_discretization = false;
    double energy_tolerance       = 0.;

    /// By what factor the second increment is expected to be smaller than the
    /// first, for an error at which to stop; zero: nothing is known, and only
    /// two increments say how large the error is.
    double expected_pace = 0.;

    /// Relative change of the normal forces at which Algorithm 2 stops.
    double outer_tolerance = 2e-7;

    /// Largest violation of the discrete law at a node with which a solution
    /// is certified, see Certificate: a part of the peak contact pressure.
    double certificate_tolerance = 1e-6;

    unsigned int maximum_cycles = 200;

    /// All attempts of the safeguards on a level together, for all positions of
    /// platens.
    unsigned int total_cycles = 5000;

    unsigned int maximum_outer_iterations = 50;

    /// Largest step length in the line search after a coarse correction.
    double maximum_step_length = 2.;

    /// Number of previous steps that a truncated coarse correction is
    /// recombined with; zero for none.
    unsigned int recombined_steps = 1;

    /// Damping of the normal forces in Algorithm 2; 1 is the plain fixed point.
    double outer_damping = 1.;

    /// Number of previous outer iterations that the normal forces of Algorithm
    /// 2 are mixed with, see MixedFixedPoint; zero for none.
    unsigned int mixed_outer_iterations = 0;

    /// Whether to try other iterations where one is getting nowhere; see
    /// SafeguardedSolver.
    bool safeguards = true;

    /// Where these may leave levels alone.
    CondensationUse condensation = CondensationUse::where_quicker;

    /// The largest ratio $\lambda/\mu$ of Lame's constants in the body: how
    /// much stiffer it is against a change of volume than against one of shape.
    double lame_ratio = 0.;

    /** Whether the volume of the body, or of a part of it, changes so little
     * that sweeps and coarse corrections become slow. */
    bool nearly_incompressible() const;

    /** Whether corrections are those that a user gets who does not choose any.
     * Who does wants to see them work. */
    bool
    has_default_corrections() const
    {
      const SolverSettings defaults;
      return coarse_correction == defaults.coarse_correction &&
        truncation == defaults.truncation &&
        maximum_step_length == defaults.maximum_step_length;
    }
  };

  /** How many smoothing steps a body of this ratio $\lambda/\mu$ needs, which
   * is what `automatic` means. */
  unsigned int enough_smoothing_steps(const double           lame_ratio,
                                      const VolumetricStrain strain);

  /** The same for recombined steps. */
  unsigned int enough_recombined_steps(const double lame_ratio);
} // namespace Friction

#endif
