#ifndef friction_algorithms_mixed_fixed_point_h
#define friction_algorithms_mixed_fixed_point_h

#include <deal.II/base/mpi.h>

#include <deque>
#include <vector>

namespace Friction
{
  /**
   * Finds the next normal forces in the outer iteration of Algorithm 2.
   *
   * The plain iteration (6.11) takes those that it has found, $\tau_{k+1}=
   * \Psi(\tau_k)$, and a damped one goes part of the way. Either converges only
   * if $\Psi$ contracts, or overshoots by not too much. With much friction it
   * does neither, but it does so in few directions: where a node changes from
   * slip to stick. Anderson mixing (D.G. Anderson, J. ACM 12, 1965) finds out
   * about these from the last steps: of all combinations of the last iterates
   * it takes the one whose residual $\Psi(\tau)-\tau$ is smallest, if $\Psi$
   * were affine, as it is while no phase changes, and then goes part of the way
   * as before.
   *
   * Phases do change, and then what is remembered is wrong. So when the
   * residual has become much larger than the smallest one so far, all of it is
   * forgotten, and the iteration goes on from that best point with half of the
   * damping.
   */
  class MixedFixedPoint
  {
  public:
    /**
     * @param depth    number of previous steps to be combined; zero for the
     *                 damped fixed point iteration.
     * @param damping  part of the way to go, in (0,1].
     */
    MixedFixedPoint(const unsigned int depth,
                    const double       damping,
                    const MPI_Comm     communicator);

    /**
     * The next point after $\tau$, which is not negative. Each process has its
     * share of the components. Collective.
     * @param given  $\tau$
     * @param found  $\Psi(\tau)$
     */
    std::vector<double> next(const std::vector<double> &given,
                             const std::vector<double> &found);

  private:
    const unsigned int depth;
    const MPI_Comm     communicator;
    double             present_damping;

    // Differences of consecutive points and of their residuals, and the last
    // ones of both, if there are any. (Not to be seen from their sizes: a
    // process without contact nodes has empty ones.)
    bool                            has_last = false;
    std::deque<std::vector<double>> steps, changes;
    std::vector<double>             last_point, last_residual;

    // The point with the smallest residual.
    double              smallest = -1.;
    std::vector<double> best_point, best_residual;
  };
} // namespace Friction

#endif
