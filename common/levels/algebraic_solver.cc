#include <common/levels/algebraic_solver.h>
#include <common/levels/elimination_cost.h>
#include <common/parallel/phase_costs.h>
#include <common/parallel/reductions.h>

#include <deal.II/base/mpi.h>

#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Friction
{
  namespace
  {
    constexpr unsigned int maximum_iterations = 200;

    // A reduction like others, to be counted like others.
    double
    product(const VectorType &a, const VectorType &b)
    {
      if (Utilities::MPI::n_mpi_processes(a.get_mpi_communicator()) > 1)
        count_reduction(a.get_mpi_communicator());
      const WaitingScope waiting(a.get_mpi_communicator());
      return a * b;
    }
  } // namespace



  AlgebraicSolver::AlgebraicSolver(const CoarsestMethod method,
                                   const unsigned int   n_components)
    : method(method)
    , n_components(n_components)
    , hierarchy_matrix(std::make_unique<TrilinosWrappers::SparseMatrix>())
  {}



  AlgebraicSolver::~AlgebraicSolver() = default;



  void
  AlgebraicSolver::initialize(const TrilinosWrappers::SparseMatrix &new_matrix)
  {
    matrix     = &new_matrix;
    is_current = false;
    if (wants_factorization())
      factorize();
    else
      // A factorisation may be left of a matrix that nothing else could cope
      // with. A hierarchy is kept.
      factors.reset();
  }



  // The couplings of later matrices are those of the first one.
  bool
  AlgebraicSolver::wants_factorization()
  {
    if (method != CoarsestMethod::automatic)
      return method == CoarsestMethod::direct;
    if (matrix->m() <= largest_direct_size)
      return true;
    if (!is_thin)
      is_thin = matrix->m() <= largest_thin_size &&
        elimination_cost(*matrix, n_components) <= largest_direct_cost;
    return *is_thin;
  }



  // The matrix may be singular: truncated functions of several nodes can have
  // become dependent. Residuals have no part in the direction that is lost, so
  // that it does not matter what stiffness it is given.
  void
  AlgebraicSolver::factorize()
  {
    if (!factors)
      factors = std::make_unique<SparseFactors>();
    if (!factors->factorize(*matrix))
      {
        const MPI_Comm comm    = matrix->get_mpi_communicator();
        const IndexSet owned   = matrix->locally_owned_range_indices();
        double         largest = 0.;
        for (const auto i : owned)
          largest = std::max(largest, matrix->diag_element(i));
        largest = Utilities::MPI::max(largest, comm);
        shifted = std::make_unique<TrilinosWrappers::SparseMatrix>();
        shifted->copy_from(*matrix);
        for (const auto i : owned)
          shifted->add(i, i, 1e-10 * largest);
        shifted->compress(VectorOperation::add);
        AssertThrow(factors->factorize(*shifted),
                    ExcMessage("The matrix is not positive semidefinite."));
      }
    is_current = true;
    ++setups;
  }



  // For elasticity the near null space is that of the translations, one per
  // component. Rotations, which the class of Trilinos does not take in older
  // releases of deal.II, save a third of the iterations and cost as much in
  // setting up. Chebyshev polynomials of degree two make more iterations than
  // Gauss-Seidel, but iterations of half the price, and are the same on any
  // number of processes.
  void
  AlgebraicSolver::make_hierarchy()
  {
    const IndexSet owned = matrix->locally_owned_range_indices();
    TrilinosWrappers::PreconditionAMG::AdditionalData data;
    data.elliptic              = true;
    data.higher_order_elements = false;
    data.smoother_type         = "Chebyshev";
    data.smoother_sweeps       = 2;
    data.aggregation_threshold = 1e-4;
    data.constant_modes.assign(n_components,
                               std::vector<bool>(owned.n_elements(), false));
    for (types::global_dof_index l = 0; l < owned.n_elements(); ++l)
      data.constant_modes[owned.nth_index_in_set(l) % n_components][l] = true;

    hierarchy_matrix->copy_from(*matrix);
    hierarchy = std::make_unique<TrilinosWrappers::PreconditionAMG>();
    hierarchy->initialize(*hierarchy_matrix, data);
    is_current     = true;
    new_iterations = 0;
    ++setups;
  }



  void
  AlgebraicSolver::solve(VectorType &x, const VectorType &b)
  {
    last_iterations = 0;
    if (is_direct() && is_thin.value_or(false))
      conjugate_gradients(x, b, [](VectorType &) {});
    else if (is_direct())
      factors->solve(x, b);
    else
      {
        iterate(x, b, [](VectorType &) {});
        if (new_iterations == 0)
          new_iterations = last_iterations;
        is_worn_out =
          (last_iterations > new_iterations + new_iterations / 2 + 2);
      }
  }



  void
  AlgebraicSolver::solve_in_subspace(VectorType       &x,
                                     const VectorType &b,
                                     const Projection &project)
  {
    last_iterations = 0;
    if (is_direct())
      conjugate_gradients(x, b, project);
    else
      iterate(x, b, project);
  }



  void
  AlgebraicSolver::iterate(VectorType       &x,
                           const VectorType &b,
                           const Projection &project)
  {
    if (!hierarchy || (is_worn_out && !is_current))
      make_hierarchy();
    Outcome outcome = conjugate_gradients(x, b, project);
    if (outcome != Outcome::converged && !is_current)
      {
        make_hierarchy();
        outcome = conjugate_gradients(x, b, project);
      }
    if (outcome == Outcome::broken)
      {
        factorize();
        conjugate_gradients(x, b, project);
      }
  }



  // With preconditioner M, r^T M r approximates the energy of the error. All
  // quantities compared with each other are energies, so that it does not
  // matter if entries of the matrix differ by orders of magnitude.
  AlgebraicSolver::Outcome
  AlgebraicSolver::conjugate_gradients(VectorType       &x,
                                       const VectorType &b,
                                       const Projection &project)
  {
    residual = b;
    project(residual);
    direction.reinit(b, true);
    preconditioned.reinit(b, true);
    image.reinit(b, true);

    x = 0.;
    precondition(preconditioned, residual);
    project(preconditioned);
    direction        = preconditioned;
    double       rMr = product(residual, preconditioned);
    const double end = tolerance * tolerance * rMr;
    if (!(rMr > 0.))
      return rMr == 0. ? Outcome::converged : Outcome::broken;

    for (last_iterations = 1;; ++last_iterations)
      {
        matrix->vmult(image, direction);
        project(image);
        const double energy = product(direction, image);
        if (!(energy > 1e-12 * rMr) || !std::isfinite(energy))
          return Outcome::broken;
        const double length = rMr / energy;
        x.add(length, direction);
        residual.add(-length, image);

        precondition(preconditioned, residual);
        project(preconditioned);
        const double rMr_before = rMr;
        rMr                     = product(residual, preconditioned);
        if (!(rMr >= 0.))
          return Outcome::broken;
        if (rMr <= end)
          return Outcome::converged;
        if (last_iterations == maximum_iterations)
          return Outcome::slow;
        direction.sadd(rMr / rMr_before, 1., preconditioned);
      }
  }



  void
  AlgebraicSolver::precondition(VectorType &x, const VectorType &b)
  {
    if (is_direct())
      factors->solve(x, b);
    else
      hierarchy->vmult(x, b);
  }
} // namespace Friction
