#ifndef friction_tests_benchmarks_elasticity_amg_h
#define friction_tests_benchmarks_elasticity_amg_h

#include <deal.II/base/point.h>

#include <tests/benchmarks/baselines/rotated_problem.h>

#include <memory>
#include <vector>

namespace Benchmark
{
  /** Blocks to be added to the diagonal blocks of contact nodes, in frames;
   * none or one per contact node. */
  template <int dim>
  using ContactBlocks = std::vector<NodeBlock<dim>>;

  /**
   * Algebraic multigrid for the stiffness matrix in the frames of the contact
   * nodes, as a preconditioner: smoothed aggregation by Trilinos' ML, which is
   * told the rigid body modes, rotations included, as near null space.
   *
   * Components that are held fixed get a row of their own with nothing but the
   * diagonal, and nodes that are held entirely take no part. Since contact
   * nodes may come loose later, vmult() divides their values by the diagonal.
   */
  template <int dim>
  class ElasticityAmg
  {
  public:
    /**
     * @param points  of all nodes.
     * @param fixed   per degree of freedom; to be held fixed.
     * @param second  derivatives of friction.
     */
    ElasticityAmg(const RotatedProblem<dim>     &rotated,
                  const std::vector<Point<dim>> &points,
                  const std::vector<char>       &fixed,
                  const ContactBlocks<dim>      &second = {});

    ~ElasticityAmg();

    /** z = M^{-1} r, in frames. */
    void vmult(VectorType &z, const VectorType &r) const;

    /** What the memory that the process has allocated grew by during set-up:
     * no accounts are kept inside of ML. */
    std::size_t
    memory_consumption() const
    {
      return memory;
    }

  private:
    struct Data;

    std::unique_ptr<Data>       data;
    std::vector<unsigned int>   nodes;            // that are not entirely fixed
    std::vector<double>         inverse_diagonal; // of what is held in contact
    const ContactBoundary<dim> &contact;
    std::size_t                 memory;
  };
} // namespace Benchmark

#endif
