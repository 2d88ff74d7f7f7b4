#ifndef friction_levels_aggregate_levels_h
#define friction_levels_aggregate_levels_h

#include <common/levels/aggregation.h>
#include <common/nodes/nodal_constraints.h>
#include <common/nodes/node_block_matrix.h>
#include <common/nodes/truncation.h>

#include <deal.II/base/point.h>

#include <array>
#include <utility>
#include <vector>

namespace Friction
{
  /**
   * A sparse matrix of dense blocks with @p n rows and @p m columns, column by
   * column, in compressed row storage.
   */
  template <int n, int m>
  struct BlockRowMatrix
  {
    std::vector<std::size_t>  starts = {0};
    std::vector<unsigned int> columns;
    std::vector<double>       values;

    unsigned int
    n_rows() const
    {
      return starts.size() - 1;
    }

    double *
    block(const std::size_t position)
    {
      return values.data() + position * (n * m);
    }

    const double *
    block(const std::size_t position) const
    {
      return values.data() + position * (n * m);
    }

    std::size_t
    memory_consumption() const
    {
      return starts.capacity() * sizeof(std::size_t) +
        columns.capacity() * sizeof(unsigned int) +
        values.capacity() * sizeof(double);
    }
  };



  /** Where the owned nodes of the leaf mesh are. */
  template <int dim>
  std::vector<Point<dim>>
  node_positions(const DoFHandler<dim>       &dof_handler,
                 const NodalConstraints<dim> &constraints);

  /**
   * Whether a stiff part and a soft one meet somewhere within a process: two
   * neighbours have diagonal blocks that differ by a factor of more than 30,
   * which cells of different sizes and corners of the body do not cause, but
   * very long cells may. Collective.
   */
  template <int dim>
  bool materials_jump(const NodeBlockMatrix<dim> &leaf_matrix,
                      const MPI_Comm              communicator);

  /**
   * Coarse levels that are made of the leaf matrix and not of the mesh, for
   * materials whose borders the coarse cells do not see: smoothed aggregation
   * (Vanek, Mandel, Brezina 1996) with truncation.
   *
   * Nodes that are strongly coupled form a group, and each group is a node of
   * the next coarser level, with the motions of a rigid body as its unknowns:
   * dim translations, and one (2D) or three (3D) rotations. So a stiff part
   * between soft ones can move as a whole, and bend from group to group, which
   * functions on coarse cells that reach across its border cannot. The motions
   * of a group are made smooth by one step of damped Jacobi's iteration,
   * $P=(I-\omega D^{-1}A)\hat P$.
   *
   * As in LevelMatrices, truncation enters the leaf blocks and never $P$:
   * $B_1=P_1^T\,T(A+\omega'')T\,P_1$, and $B_{k+1}=P_{k+1}^TB_kP_{k+1}$
   * (levels count from the leaf mesh here; functions number them from 0 on).
   * When the truncation changes at
   * some nodes, only the rows that depend on them are computed anew.
   *
   * The coarsest level is solved if it has few nodes; where no couplings are
   * strong any more it may have many, and is relaxed like all others.
   *
   * Groups do not reach across processes, and each process solves for its own
   * nodes as if all others were held.
   */
  template <int dim>
  class AggregateLevels
  {
  public:
    /// Unknowns of a node of a level: motions of a rigid body.
    static constexpr int n_motions = dim * (dim + 1) / 2;

    /**
     * @param leaf_matrix  kept by reference.
     * @param positions    of the owned nodes.
     */
    AggregateLevels(const NodeBlockMatrix<dim>    &leaf_matrix,
                    const NodalConstraints<dim>   &constraints,
                    const std::vector<Point<dim>> &positions);

    /** Brings all levels up to date with @p truncation. Returns the number of
     * rows that were computed. */
    std::size_t update(const Truncation<dim> &truncation);

    /**
     * v = T P (V-cycle) P^T T r, symmetric and positive semidefinite.
     * @param v  at owned leaf nodes.
     * @param r  likewise, truncated.
     */
    void apply(double *v, const double *r);

    /** The truncation that the matrices are up to date with. */
    const Truncation<dim> &
    current_truncation() const
    {
      return truncation;
    }

    /** Without the leaf mesh. */
    unsigned int
    n_levels() const
    {
      return levels.size();
    }

    /** Of the matrix $B_{k+1}$, where k is @p level. */
    unsigned int
    n_nodes(const unsigned int level) const
    {
      return levels[level].matrix.n_rows();
    }

    /** fine = P coarse, from level @p k to the next finer one, or from the
     * first one to the owned leaf nodes. */
    void
    prolongate(const unsigned int k, double *fine, const double *coarse) const;

    /** $y = B_{k+1} x$. */
    void vmult(const unsigned int k, double *y, const double *x) const;

    std::size_t memory_consumption() const;

    /** P from a level of blocks of n rows to the next coarser one. */
    template <int n>
    struct Prolongation
    {
      static constexpr int n_columns = n_motions;

      BlockRowMatrix<n, n_motions> rows;

      // The transposed pattern: where the columns stand in the rows.
      std::vector<std::size_t>                          starts;
      std::vector<std::pair<unsigned int, std::size_t>> entries;
    };

  private:
    using Block = std::array<double, n_motions * n_motions>;

    struct Level
    {
      BlockRowMatrix<n_motions, n_motions> matrix;
      std::vector<Block>                   inverses;
      std::vector<double>                  rhs, correction, defect;

      // To this level from the next coarser one.
      Prolongation<n_motions> prolongation;
    };

    const NodeBlockMatrix<dim> &leaf_matrix;
    Truncation<dim>             truncation;
    Prolongation<dim>           leaf_prolongation;
    std::vector<Level>          levels; // from fine to coarse
    std::vector<double>         coarsest_inverse;

    void compute_inverse(Level &level, const unsigned int row);

    void invert_coarsest();

    void visit(const unsigned int k);

    void relax(Level &level, const bool backwards);
  };
} // namespace Friction

#endif
