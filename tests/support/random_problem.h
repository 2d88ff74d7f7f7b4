#ifndef friction_tests_support_random_problem_h
#define friction_tests_support_random_problem_h

#include <common/discretization/discretization.h>
#include <common/levels/level_hierarchy.h>
#include <common/nodes/truncation.h>

#include <deal.II/base/mpi.h>

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <utility>

#include <tests/support/random.h>

namespace Tests
{
  using namespace dealii;
  using namespace Friction;

  /**
   * A block on a plane, its top pushed down and sideways. Contact may happen
   * on all of its bottom, and on no Dirichlet node.
   */
  template <int dim>
  Parameters block_parameters(const FrictionLaw law,
                              const double      friction_coefficient);



  /**
   * A body and an obstacle whose normals point in all directions. In 2D that is
   * the half disc on a plane. In 3D the block comes down on a rod that crosses
   * it askew, and is pushed along it; normals are those of the rod.
   */
  template <int dim>
  Parameters curved_parameters(const FrictionLaw law,
                               const double      friction_coefficient);



  /**
   * Refines cells picked at random, those near the bottom more often, and
   * coarsens some others: hanging nodes next to the contact boundary, and mesh
   * sizes that change towards it and away from it.
   */
  template <int dim>
  void refine_at_random(Triangulation<dim> &mesh,
                        const unsigned int  n_rounds,
                        const double        density,
                        Random             &random);



  /**
   * The number of nodes that hang on the contact boundary and have a master
   * among the contact nodes for which a condition holds. The condition is asked
   * with the number of the contact node. In 2D the boundary is a line, on which
   * no node hangs.
   */
  template <int dim>
  unsigned int
  n_hanging_at_contact(const Discretization<dim>               &discretization,
                       const types::boundary_id                 boundary_id,
                       const std::function<bool(unsigned int)> &holds);



  /** A scene, a mesh refined at random for it, and its discretisation. */
  template <int dim>
  struct RandomProblem
  {
    RandomProblem(const Parameters  &parameters,
                  const unsigned int n_rounds,
                  const double       density,
                  Random            &random);

    /** Afterwards, and everywhere. */
    void refine_global(const unsigned int n);

    const NodalConstraints<dim> &
    constraints() const
    {
      return discretization.constraints();
    }

    const ContactBoundary<dim> &
    contact() const
    {
      return discretization.contact();
    }

    const LevelHierarchy<dim> &
    hierarchy() const
    {
      return *level_hierarchy;
    }

    const NodeBlockMatrix<dim> &
    matrix() const
    {
      return discretization.stiffness().blocks();
    }

    /** The discrete problem with another coefficient of friction. */
    DiscreteProblem<dim>
    friction_problem(const double      coefficient,
                     const FrictionLaw law = FrictionLaw::tresca) const;

    VectorType
    leaf_vector() const
    {
      return VectorType(constraints().partitioner());
    }

    unsigned int n_hanging() const;

    /** See there. */
    unsigned int
    n_hanging_at_contact(const std::function<bool(unsigned int)> &holds) const;

    /** The number of hanging nodes one of whose masters is truncated although
     * nothing is prescribed there. */
    unsigned int
    n_hanging_with_truncated_master(const Truncation<dim> &truncation) const;

    const Scene<dim>                    scene;
    std::unique_ptr<Triangulation<dim>> mesh;
    Discretization<dim>                 discretization;

  private:
    std::unique_ptr<LevelHierarchy<dim>> level_hierarchy;

    void discretize();
  };



  /** The matrix as a dense one; hanging nodes have zero rows and columns. */
  template <int dim>
  Eigen::MatrixXd to_dense(const NodeBlockMatrix<dim> &A);



  /** Sets a block of a symmetric matrix, given column by column, to the right
   * of the diagonal, and its transpose if that is stored, too. */
  template <int dim>
  void
  set_symmetric(NodeBlockMatrix<dim> &A,
                const unsigned int    row,
                const std::size_t     position,
                const NodeBlock<dim> &block)
  {
    A.set(row, position, block);
    const unsigned int column = A.column(position);
    if (stores_half<dim> || column >= A.n_rows())
      return;
    NodeBlock<dim> transposed;
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int r = 0; r < dim; ++r)
        transposed[r * dim + c] = block[c * dim + r];
    A.set(column, A.find(column, row), transposed);
  }



  VectorType to_vector(const Eigen::VectorXd &x, const VectorType &like);



  Eigen::VectorXd to_eigen(const VectorType &v);



  /** A unit vector of random direction. */
  template <int dim>
  Eigen::Matrix<double, dim, 1> random_direction(Random &random);



  /**
   * At a node, an orthogonal projector of random rank and direction, and a
   * positive semidefinite curvature on its range.
   * @param scale  of the curvature, zero for none.
   */
  template <int dim>
  void truncate_at_random(Truncation<dim>   &truncation,
                          const unsigned int node,
                          const unsigned int rank,
                          const double       scale,
                          Random            &random);



  /** The same at all contact nodes. */
  template <int dim>
  Truncation<dim> random_truncation(const NodalConstraints<dim> &constraints,
                                    const ContactBoundary<dim>  &contact,
                                    const double                 scale,
                                    Random                      &random);



  /** T and omega'' of all leaf nodes, as dense matrices. */
  template <int dim>
  std::pair<Eigen::MatrixXd, Eigen::MatrixXd>
  to_dense(const Truncation<dim> &truncation, const unsigned int n_nodes);
} // namespace Tests

#endif
