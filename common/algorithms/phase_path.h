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
   * friction Klarbring 1987). It is for problems with a dense matrix, as that
   * of CondensedSolver.
   *
   * In the plane a node has four phases: open, sticking, sliding one way and
   * sliding the other way. In each of them two relations between its
   * displacement and its force are known, so that for given phases of all nodes
   * there are as many linear equations as unknowns. With loads $(1-t)f_0+tf$,
   * where a solution for $f_0$ is known, a path leads on from there: as t
   * grows, all unknowns change in proportion, until the first one is at the end
   * of what its phase allows: a gap closes, a pressure vanishes, a slip comes
   * to rest, or friction is at its bound. There one node goes into its next
   * phase, and the unknown that becomes free in it is increased next, whichever
   * way t goes then. So a path can turn where a solution ceases to exist for
   * more load. At t=1 it has arrived.
   *
   * It does arrive, for any F, since the load of the start has no other
   * solution. At the start, $u_0,r_0$, nodes that touch stick, with any normal
   * force $r_{0,n}\ge0$ and no tangential one, and others have slipped by
   * $v_0$, $F|v_0|\le g-u_{0,n}$. If $u,r$ solves the problem with the same
   * load,
   * @f[ (r-r_0)^TS^{-1}(r-r_0) = -(r-r_0)\cdot(u-u_0). @f]
   * With the slip v of u, $r_Tv=F r_n|v|$, and $r_n(u_n-g)=0$, a node adds to
   * the right hand side
   * - $r_{0,n}(u_n-g)-F r_n|v|$ if it touches at the start,
   * - $-r_n(g-u_{0,n})-F r_n|v|+r_Tv_0$ if it does not,
   *
   * neither of which is positive, since $|r_T|\le F r_n$. (If its bound is
   * given, it sticks at the start without a tangential force, and adds
   * $-|r_Tv|$.) Hence $r=r_0$, and since all that touches at the start presses
   * and all else has a distance, also phases are the same: the path cannot come
   * back to t=0. Solutions for loads between are bounded, by the same equation,
   * with the product of $S^{-1}(r-r_0)$ and the difference of loads added to
   * its right hand side; so no piece of the path is a ray. It goes through none
   * of them twice, and there are finitely many. So it gets to t=1; unless two
   * nodes change phases at once, or S is singular, since nothing but contact
   * holds the body. In symmetric problems two nodes would: distances and normal
   * forces of the start are multiplied by random numbers. It follows that there
   * is a solution, and, nearly always, that their number is odd.
   *
   * How many changes of phase there are, nothing is known of. From the contact
   * zone of a good guess they have been fewer than there are nodes, of which
   * most have to be told how they slip.
   *
   * Each of them exchanges a column of the matrix, see BasisInverse, and takes
   * some $n^2$ multiplications; the factorisation at the beginning takes
   * $n^3/6$ at most.
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
    PhasePath(std::vector<double>      &&matrix,
              const std::vector<double> &load,
              const std::vector<Node>   &nodes);

    /**
     * The path begins with the contact zone of a guess.
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

    /** In bytes. */
    std::size_t memory_consumption() const;

  private:
    // Without a tangential unknown a node has no friction.
    const std::size_t n;
    std::vector<Node> nodes;

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
    void find_values(const unsigned int increased);
    bool arrive();

    void   find_rates(const unsigned int increased, const double sign);
    Event  first_event(const unsigned int increased) const;
    void   advance(const double length);
    bool   turn_to_other_side(const unsigned int k);
    double enter_next_phase(const unsigned int k);
  };
} // namespace Friction

#endif
