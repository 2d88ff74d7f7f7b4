#ifndef friction_algorithms_phase_path_h
#define friction_algorithms_phase_path_h

#include <common/algorithms/basis_inverse.h>

#include <cstddef>
#include <vector>

namespace Friction
{
  /**
   * Finds a solution of the discrete contact problem with Coulomb's law in two
   * dimensions, whatever the coefficient of friction, by following a path from
   * phase to phase: complementary pivoting (Lemke 1965; for contact with
   * friction Klarbring 1990). It is for problems with a dense matrix, as that
   * of CondensedSolver.
   *
   * In the plane a node has four phases: open, sticking, sliding one way and
   * sliding the other way. In each of them two of its components are known, of
   * displacement or force, and two have to be found, so that for given phases
   * of all nodes there are as many linear equations as unknowns. Loads
   * $(1-t)f_0+tf$, where the problem with $f_0$ has a solution that is known,
   * then lead from it along a broken line: as t grows, all unknowns change in
   * proportion, until the first one is at the end of what its phase allows: a
   * gap closes, a pressure vanishes, a slip comes to rest, or friction is at
   * its bound. There one node goes into its next phase, and the unknown that
   * becomes free there is increased next, whichever way t goes then. So a path
   * can turn where a solution ceases to exist, as an iteration with steps of
   * its own, or less friction at first, cannot. With t=1 it has arrived.
   *
   * It does arrive, since no other solution has the load of the start
   * $u_0,r_0$: there nodes that touch stick, with any normal and no tangential
   * force, and others have slipped no more than their distance divided by F.
   * For if $u,r$ has the same load,
   * @f[ (r-r_0)^TS^{-1}(r-r_0) = -(r-r_0)\cdot(u-u_0), @f]
   * and no node has a part in the right hand side that is positive. Normal
   * components have not, because contact is monotone. With $r_{0,T}=0$ the
   * tangential ones give $-r_T(u_T-u_{0,T})\le-F r_n(|u_T|-|u_{0,T}|)$, where
   * $u_{0,T}$ vanishes or, times F, is at most the distance $g-u_{0,n}$, by
   * which $r_n$ is multiplied in the normal part. Hence $r=r_0$. So the path
   * cannot come back to t=0. By the same equation all solutions with loads
   * between are bounded, whatever F is. A path that neither ends nor comes
   * back, in a bounded set where it has but finitely many pieces, gets to t=1;
   * unless two nodes change phases at once, or the body is held by friction
   * alone, so that S is singular. This also proves that there is a solution.
   *
   * How many changes of phase that takes nothing is known of. If the start has
   * the contact zone of a good guess, they are about as many as there are
   * nodes, most of which have to be told how they slip.
   *
   * A change of phase exchanges one column of the matrix, whose inverse is
   * updated with two n^2 multiplications; the first inverse takes n^3.
   */
  class PhasePath
  {
  public:
    static constexpr unsigned int nowhere = static_cast<unsigned int>(-1);

    /** A contact node: which unknowns are its own, and what its law has. */
    struct Node
    {
      unsigned int normal;      ///< displacement along the normal
      unsigned int tangential;  ///< nowhere if that is prescribed
      double       gap;         ///< a length
      double       slip_origin; ///< slip counts from there; a length
      double       coefficient; ///< F of Coulomb's law; zero without it
      double       bound;       ///< of Tresca's law, a force; zero without it
    };

    struct Phase
    {
      bool in_contact = false;
      bool sticks     = false;
      int  side       = 1; ///< to which it slides
    };

    /**
     * @param matrix  S, n times n, symmetric, by columns.
     * @param load    f, of n unknowns; those that belong to no contact node are
     *                free.
     */
    PhasePath(const std::vector<double> &matrix,
              const std::vector<double> &load,
              const std::vector<Node>   &nodes);

    /**
     * The path begins near a guess.
     * @param touches       of each node, whether it does.
     * @param displacement  n of them, from which distances are taken.
     * @param force         n forces of the body on the obstacle, from which
     *                      normal ones are taken.
     */
    void begin(const std::vector<char>   &touches,
               const std::vector<double> &displacement,
               const std::vector<double> &force);

    /** Follows the path to its end. Returns whether it has arrived; not if the
     * matrix of some phases is singular, or if this takes more multiplications
     * than @p most. */
    bool follow(const double most);

    /** What following has taken. */
    unsigned int
    n_changes_of_phase() const
    {
      return n_changes;
    }
    double
    n_multiplications() const
    {
      return inverse.n_multiplications();
    }

    /** Where the path has arrived. */
    const std::vector<Phase> &
    phases() const
    {
      return now;
    }
    std::vector<double> displacement() const;
    std::vector<double> force() const;

  private:
    const std::size_t       n;
    const std::vector<Node> nodes;

    // The largest number on the diagonal of S, which forces are divided by, so
    // that all unknowns are lengths; and S divided by it.
    const double        unit;
    std::vector<double> matrix;

    // Of each unknown, the node that it belongs to, or nowhere, and where
    // displacements count from: gaps, origins of slip, or zero.
    std::vector<unsigned int> node_of;
    std::vector<double>       origin;

    // The load, with displacements that count from there, and the difference
    // from that of the start.
    std::vector<double> load, way;

    // The phases, and the unknowns: in direction k the displacement, or, if
    // that is held, the force; if it is the tangential one, what it lacks to
    // the bound on its side.
    std::vector<Phase>  first, now;
    std::vector<double> value, rate;
    double              t = 0., rate_of_t = 0.;

    // The inverse of the equations for the phases of the moment; which unknown
    // each of its rows is about, where t is number n; and in which row an
    // unknown is. One has no row: that which is increased.
    BasisInverse              inverse;
    std::vector<unsigned int> in_row, row_of;

    unsigned int n_changes = 0;

    // Of the unknown that is increased: its column, and the inverse times that.
    std::vector<double> column, image;

    // What happens first on the way: after what length, to which unknown, how
    // fast, and whether that is at the bound on the other side.
    struct Event
    {
      double       length;
      unsigned int unknown;
      double       speed;
      bool         on_other_side;
    };

    bool has_friction(const Node &node) const;
    bool rubs(const unsigned int p) const;
    bool is_held(const unsigned int k, const std::vector<Phase> &phases) const;
    bool is_held(const unsigned int k) const;
    bool has_first_column(const unsigned int k) const;
    double bound(const unsigned int p) const;
    double force_at(const unsigned int k) const;

    void find_start_of_way();
    void find_column(const unsigned int k);
    void find_image();
    bool exchange(const unsigned int row, const unsigned int k);
    bool begin_inverse();
    void begin_anew();
    bool find_inverse(const unsigned int increased);
    bool arrive();

    void   find_rates(const unsigned int increased, const double sign);
    Event  first_event(const unsigned int increased) const;
    void   advance(const double length);
    bool   turn_to_other_side(const unsigned int k);
    double enter_next_phase(const unsigned int k);
  };
} // namespace Friction

#endif
