#ifndef friction_algorithms_force_control_h
#define friction_algorithms_force_control_h

#include <common/algorithms/solver_report.h>
#include <common/contact/contact_state.h>
#include <common/discretization/discretization.h>
#include <common/parameters/solver_settings.h>
#include <common/scene/scene.h>

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace Friction
{
  /**
   * Finds how far the platens of a scene have to be moved, so that the forces
   * on them are those that the scene asks for, see Platen.
   *
   * With positions $s$ of all controlled components, the forces $R(s)$ of what
   * holds the body are the reactions of the solution with these displacements
   * prescribed: its residual, summed over the nodes of a platen. $R(s)=G$ is an
   * equation in as many unknowns as there are controlled components, one as a
   * rule, and Broyden's method solves it, which for one unknown is the secant
   * method. To begin with, the body is as stiff as if all but the platen were
   * held, $e^TAe$ with the displacement $e$ of the platen; this is far too
   * stiff, so that the first step is too short, and never too long. What is
   * learnt is kept from one mesh, and from one load step, to the next. So a
   * fine mesh takes few positions more, each from a good guess.
   *
   * As long as forces are far from what they should be, they need not be known
   * better than that: solutions on the way are solved roughly.
   *
   * A body that is not touched yet gives no resistance; steps then grow tenfold
   * until something is met. Of a single position an interval is known from what
   * has been tried, since the force grows with it; the interval is halved where
   * the secant method is no good.
   *
   * If the scene has no platens, nothing here does anything.
   */
  template <int dim>
  class ForceControl
  {
  public:
    using SolveOnce = std::function<SolverReport(const double accuracy)>;

    /** @param scene  whose platens are moved; kept by reference. */
    explicit ForceControl(Scene<dim> &scene);

    /**
     * Solves, compares forces, moves platens, and solves again, until each
     * force is the given one up to a tolerance.
     *
     * @param discretization  whose prescribed values follow the platens.
     * @param u      displacement: what solve_once solves for, and, on call, its
     *               initial guess.
     * @param state  the same of the contact nodes.
     * @param settings  of what solve_once solves with. Forces are found when
     *               they are those of the scene up to the tolerance of the
     *               certificate, relative to the largest force on the body that
     *               there has been, or up to rounding of the largest one that
     *               the search has met; if energy_tolerance is set, also the
     *               displacement that is missing must have no larger energy
     *               norm, or forces must be right to a millionth.
     * @param solve_once  solves with the displacements that are prescribed now,
     *                    from the guess that @p u and @p state are, up to
     *                    relative increments of its argument; zero: as well as
     *                    the caller wants the solution.
     * @return the report of the last solution, with the cycles of all. If it
     *         has not converged, platens, u and state are those of that
     *         attempt.
     *
     * Throws InputError if sixty positions are not enough, if a platen would
     * have to be moved farther than the body is large, or if a part of it is
     * held by something else. Collective.
     */
    SolverReport solve(Discretization<dim>  &discretization,
                       VectorType           &u,
                       ContactState         &state,
                       const SolverSettings &settings,
                       const SolveOnce      &solve_once);

    /** Where the platens are, and all that has been learnt, in numbers for
     * restore(), which takes those of the same scene. The discretisation has to
     * be set up anew after that. */
    std::vector<double> checkpoint_numbers() const;
    void                restore(const std::vector<double> &numbers);

    /** Moves the platens to where their forces, which the scene has changed by
     * going to another load step, should be. The discretisation has to be set
     * up anew. */
    void predict();

  private:
    struct Control
    {
      unsigned int condition, component;
    };

    // What has been found with the platens in a position.
    struct Sample
    {
      Eigen::VectorXd positions, forces, missing;
      VectorType      displacement, tractions;
      double          accuracy; ///< of its solution; zero: no rough one

      /// The largest force on the body, of this one and of solutions before,
      /// but not less than what makes the tolerance larger than rounding.
      double unit;

      /// Whether the forces are those that the scene asks for.
      bool is_found;

      double
      error() const
      {
        return missing.cwiseAbs().maxCoeff();
      }
    };

    // The degrees of freedom of each control on this process.
    using PlatenDofs = std::vector<std::vector<unsigned int>>;

    Scene<dim>          &scene;
    std::vector<Control> controls;
    Eigen::MatrixXd      compliance;     // ds/dR; empty until it is known
    Eigen::VectorXd      wanted;         // of the last solution
    double               unit      = 0.; // the largest force of all solutions
    bool                 is_learnt = false;

    Eigen::VectorXd positions() const;
    void            move_to(const Eigen::VectorXd &positions);
    Eigen::VectorXd given_forces() const;
    PlatenDofs      find_dofs(const Discretization<dim> &discretization) const;

    void begin_with_stiffness_of_body(const Discretization<dim> &discretization,
                                      const PlatenDofs          &dofs);

    void learn(const Sample &before, const Sample &now);

    [[noreturn]] void give_up(const Sample &nearest) const;
  };
} // namespace Friction

#endif
