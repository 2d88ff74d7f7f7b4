#ifndef friction_iteration_truncated_correction_h
#define friction_iteration_truncated_correction_h

#include <common/iteration/correction.h>
#include <common/levels/levels.h>

#include <vector>

namespace Friction
{
  /**
   * One multigrid cycle for the truncated linear problem
   * $T(A+\omega'')T\,v = r$: everything below the leaf mesh.
   *
   * Restricted residuals go down, block Gauss-Seidel relaxes each level before
   * and after the coarser levels, and the coarsest level is solved by
   * CoarsestSolver. Sweeps are in the same order before and after, which suits
   * matrices stored by halves, see stores_half. So the V-cycle is not
   * symmetric, and need not be: each of its steps lowers the energy of the
   * truncated problem, so that the energy norm of the error shrinks, and v is a
   * direction of descent. With local refinement a level sees residuals from two
   * sides: those of its own leaf nodes, and those restricted from the next
   * finer level. The finest level has no unknowns of its own, since the leading
   * relaxation has been there: it only passes residuals down and corrections
   * up.
   *
   * The recursion is our own: that of deal.II's class Multigrid runs W-cycles
   * as V-cycles in the releases up to 9.7, relaxes the finest level like all
   * others, and its edge matrices are those of local smoothing without
   * truncation.
   *
   * Where cells are stretched, lines or planes of strongly coupled nodes have
   * to be relaxed together, see StretchedRelaxation. The leading relaxation
   * goes node by node. So this correction relaxes those of the leaf mesh,
   * before and after everything else, lines with half as many sweeps, and
   * Levels::relax() those of the levels. Coarse levels are worth more then: a
   * level that has at most a third of the nodes of the next finer one, of which
   * half or more are in lines or planes, is visited twice also in a V-cycle, on
   * four levels at most.
   */
  template <int dim>
  class TruncatedCorrection : public Correction<dim>
  {
  public:
    /** @p levels is kept by reference. */
    TruncatedCorrection(Levels<dim>       &levels,
                        const Cycle        cycle,
                        const unsigned int smoothing_steps)
      : TruncatedCorrection(levels, cycle, smoothing_steps, true)
    {}

    void update(const Linearization<dim> &linearization,
                const Iterate            &x) override;

    void apply(VectorType &v, const VectorType &r) override;

    std::size_t memory_consumption() const override;

  protected:
    /** @p relaxes_together: relaxes lines or planes where there are some. */
    TruncatedCorrection(Levels<dim>       &levels,
                        const Cycle        cycle,
                        const unsigned int smoothing_steps,
                        const bool         relaxes_together);

    Levels<dim> &levels;

    // Per level: right hand side, correction, and what a visit leaves over. If
    // a cycle comes to a level again, corrections accumulate over its visits.
    std::vector<VectorType> rhs, correction, defect;

    // What a cycle with bounds does in another way: to set up, to get ready for
    // the visits to a level that has got its right hand side, to relax it, and
    // to solve on the coarsest level.
    virtual void
    prepare_visits(const unsigned int /*level*/)
    {}

    // Makes the vectors of the levels, in the first cycle.
    virtual void set_up();

    virtual void relax(const unsigned int level, VectorType *defect_after);

    virtual void solve_coarsest();

  private:
    const VectorType *leaf_residual = nullptr;
    VectorType        leaf_defect, leaf_start;

    // How often a level is visited per visit of the next finer one, and whether
    // it has not been visited yet in this cycle.
    std::vector<unsigned int> n_visits;
    std::vector<char>         is_untouched;

    // What the next coarser level had when a visit began, and a vector of work;
    // empty until a level is visited again within a cycle, which a V-cycle does
    // not do: at a first visit the next coarser level is zero yet.
    std::vector<VectorType> start, work;

    const bool  relaxes_together;
    const Cycle cycle;
    bool        relaxes_leaf = false;

    void visit(const unsigned int level);

    void restrict_residual(const unsigned int level);

  protected:
    const unsigned int smoothing_steps;
  };
} // namespace Friction

#endif
