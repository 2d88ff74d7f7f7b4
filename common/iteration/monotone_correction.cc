#include <common/iteration/monotone_correction.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace Friction
{
  namespace
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
  } // namespace



  template <int dim>
  MonotoneCorrection<dim>::MonotoneCorrection(
    Levels<dim> &levels, const Cycle cycle, const unsigned int smoothing_steps)
    : TruncatedCorrection<dim>(levels, cycle, smoothing_steps, false)
  {}



  template <int dim>
  void
  MonotoneCorrection<dim>::set_up()
  {
    Base::set_up();
    coarsest_step = levels.vector(0);
    for (unsigned int k = 0; k < levels.n_correction_levels(); ++k)
      {
        const auto &level = levels.hierarchy().level(k);
        lower.push_back(levels.vector(k));
        upper.push_back(levels.vector(k));
        restricted.emplace_back(4 * dim * level.n_local_nodes());
        transfer_ghosts.emplace_back(level.numbering(),
                                     level.transfer_ghosts());
      }
  }



  template <int dim>
  void
  MonotoneCorrection<dim>::update(const Linearization<dim> &linearization,
                                  const Iterate            &x)
  {
    leaf_lower.reinit(x.u, true);
    leaf_upper.reinit(x.u, true);
    linearization.bounds(leaf_lower, leaf_upper, x);
    Base::update(linearization, x);
  }



  template <int dim>
  void
  MonotoneCorrection<dim>::set_bounds(const VectorType &lower_bounds,
                                      const VectorType &upper_bounds)
  {
    leaf_lower = lower_bounds;
    leaf_upper = upper_bounds;
  }



  // Monotone restriction: what the finer nodes in the support of a coarse
  // function have left, added to what the coarse node has already moved; and
  // the bounds of the level's own leaf nodes, which are bounds of all of it.
  // The lower bounds are turned around, so that there are only minima.
  template <int dim>
  void
  MonotoneCorrection<dim>::prepare_visits(const unsigned int k)
  {
    const auto          &level  = levels.hierarchy().level(k);
    std::vector<double> &bounds = restricted[k];
    std::fill(bounds.begin(), bounds.end(), infinity);

    // What children have left, upwards and downwards.
    const auto take_minima = [&](const auto &children, const auto &room) {
      for (unsigned int node = 0; node < level.n_local_nodes(); ++node)
        for (auto child = children.begin(node); child != children.end(node);
             ++child)
          for (unsigned int d = 0; d < dim; ++d)
            {
              const std::array<double, 2> left  = room(child->node, d);
              double                     *bound = &bounds[4 * (dim * node + d)];
              bound[0]                          = std::min(bound[0], left[0]);
              bound[1]                          = std::min(bound[1], left[1]);
            }
    };
    if (level.has_leaf_children())
      take_minima(
        level.leaf_children(),
        [&](const LeafNode     child,
            const unsigned int d) -> std::array<double, 2> {
          const unsigned int i = dim * child.number() + d;
          return {{leaf_upper.local_element(i), -leaf_lower.local_element(i)}};
        });
    else
      take_minima(level.children(),
                  [&](const unsigned int child,
                      const unsigned int d) -> std::array<double, 2> {
                    const unsigned int i = dim * child + d;
                    const double moved   = correction[k + 1].local_element(i);
                    return {{upper[k + 1].local_element(i) - moved,
                             moved - lower[k + 1].local_element(i)}};
                  });
    for (const auto &own : level.own_nodes())
      for (unsigned int d = 0; d < dim; ++d)
        {
          double            *bound = &bounds[4 * (dim * own.node + d)];
          const unsigned int leaf  = dim * own.leaf.number() + d;
          bound[2] = std::min(bound[2], leaf_upper.local_element(leaf));
          bound[3] = std::min(bound[3], -leaf_lower.local_element(leaf));
        }
    transfer_ghosts[k].collect(
      bounds.data(), 4 * dim, GhostExchange::Combine::minimum);

    for (unsigned int i = 0; i < dim * level.n_nodes(); ++i)
      {
        const double *bound = &bounds[4 * i];
        const double  moved = correction[k].local_element(i);
        upper[k].local_element(i) =
          std::min(moved + std::max(0., bound[0]), bound[2]);
        lower[k].local_element(i) =
          std::max(moved - std::max(0., bound[1]), -bound[3]);
      }
  }



  template <int dim>
  void
  MonotoneCorrection<dim>::relax(const unsigned int k, VectorType *defect_after)
  {
    const PhaseScope phase(levels.communicator(), SolverPhase::coarse_sweeps);
    for (unsigned int step = 0; step < smoothing_steps; ++step)
      relax_within_bounds(k, levels.hierarchy().level(k).relaxed_nodes());
    if (defect_after != nullptr)
      levels.matrices().matrix(k).residual(
        defect_after->begin(), rhs[k].begin(), correction[k].begin());
  }



  // Minimise over the node's box. Where the unconstrained block solution lies
  // inside, it is the minimiser; otherwise a few steps of coordinate descent,
  // each of which stays inside and lowers the energy, come close enough.
  template <int dim>
  void
  MonotoneCorrection<dim>::relax_within_bounds(const unsigned int k,
                                               const NodeRanges  &nodes)
  {
    const LevelMatrices<dim>   &matrices = levels.matrices();
    const NodeBlockMatrix<dim> &B        = matrices.matrix(k);
    double                     *c        = correction[k].begin();
    const double               *b = rhs[k].begin(), *lo = lower[k].begin(),
                 *up = upper[k].begin();

    const auto relax_node = [&](const unsigned int i) {
      if (B.is_empty(i))
        return;
      const NodeBlock<dim> &inverse = matrices.inverse_diagonals(k)[i];
      NodeValue<dim>        defect  = B.row_times(i, c);
      for (unsigned int d = 0; d < dim; ++d)
        defect[d] = b[dim * i + d] - defect[d];
      NodeValue<dim> step = times<dim>(inverse.data(), defect.data());

      bool inside = true;
      for (unsigned int d = 0; d < dim; ++d)
        inside = inside && c[dim * i + d] + step[d] <= up[dim * i + d] &&
          c[dim * i + d] + step[d] >= lo[dim * i + d];
      if (!inside)
        {
          const NodeBlock<dim> block = matrices.majorized_diagonal(k, i);
          NodeValue<dim>       before;
          step = NodeValue<dim>{};
          for (unsigned int sweep = 0; sweep < 10; ++sweep)
            {
              before = step;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  // A component that cannot move has a zero row in the inverse.
                  if (inverse[d * dim + d] == 0.)
                    continue;
                  double gradient = defect[d];
                  for (unsigned int e = 0; e < dim; ++e)
                    if (e != d)
                      gradient -= block[e * dim + d] * step[e];
                  step[d] = std::min(
                    std::max(gradient / block[d * dim + d],
                             std::min(0., lo[dim * i + d] - c[dim * i + d])),
                    std::max(0., up[dim * i + d] - c[dim * i + d]));
                }
              if (before == step)
                break;
            }
        }
      for (unsigned int d = 0; d < dim; ++d)
        c[dim * i + d] += step[d];
    };

    for (const auto &range : nodes)
      for (unsigned int i = range.first; i < range.second; ++i)
        relax_node(i);
    levels.coupled_ghosts(k).update(c, dim);
  }



  // Adds the step in coarsest_step, with defect[0] the residual that it was
  // found for. A step that leaves the bounds is projected back, or if the
  // energy does not like this, shortened. Returns whether the bounds allow the
  // whole step.
  template <int dim>
  bool
  MonotoneCorrection<dim>::step_within_bounds()
  {
    const MPI_Comm     comm     = levels.communicator();
    const unsigned int n_values = dim * levels.hierarchy().level(0).n_nodes();
    double            *c        = correction[0].begin();
    const double      *step = coarsest_step.begin(), *r = defect[0].begin(),
                 *lo = lower[0].begin(), *up = upper[0].begin();
    const auto clamp = [&](const unsigned int i, const double length) {
      return std::min(std::max(c[i] + length * step[i], lo[i]), up[i]);
    };

    double admissible = 1.;
    for (unsigned int i = 0; i < n_values; ++i)
      {
        const double room = (step[i] > 0 ? up[i] : lo[i]) - c[i];
        if (std::abs(step[i]) > std::abs(room))
          // Rounding may have left it an ulp outside.
          admissible = std::min(admissible, std::max(0., room / step[i]));
      }
    admissible    = -max_over_processes(-admissible, comm);
    double length = 1.;
    if (admissible < 1.)
      {
        VectorType part(levels.vector(0));
        const auto lowers_energy = [&]() {
          for (unsigned int i = 0; i < n_values; ++i)
            part.local_element(i) = clamp(i, length) - c[i];
          levels.coupled_ghosts(0).update(part.begin(), dim);
          double gain =
            -.5 * levels.matrices().matrix(0).energy_product(part.begin());
          for (unsigned int i = 0; i < n_values; ++i)
            gain += r[i] * part.local_element(i);
          return sum_over_processes(gain, comm) > 0;
        };
        while (length > std::max(admissible, .01) && !lowers_energy())
          length *= .5;
        if (length <= std::max(admissible, .01))
          length = admissible;
      }
    for (unsigned int i = 0; i < n_values; ++i)
      c[i] = clamp(i, length);
    levels.coupled_ghosts(0).update(c, dim);
    return admissible == 1.;
  }



  // The solution serves if it happens to be admissible. Otherwise, in turns,
  // relax, which settles what touches its bounds and what leaves them, and
  // solve for all that does not touch. Each part stays within the bounds and
  // lowers the energy, so that it may end anywhere; what is left over is left
  // to the next cycle. Few nodes have bounds, however many the level has: few
  // turns do.
  template <int dim>
  void
  MonotoneCorrection<dim>::solve_coarsest()
  {
    const PhaseScope   phase(levels.communicator(), SolverPhase::coarsest);
    const unsigned int n_nodes    = levels.hierarchy().level(0).n_nodes();
    const unsigned int n_values   = dim * n_nodes;
    const NodeBlockMatrix<dim> &B = levels.matrices().matrix(0);
    double       *c = correction[0].begin(), *step = coarsest_step.begin();
    double       *r  = defect[0].begin();
    const double *lo = lower[0].begin(), *up = upper[0].begin();

    levels.coupled_ghosts(0).update(c, dim);
    B.residual(r, rhs[0].begin(), c);
    levels.coarsest_solver().solve(step, r);
    if (step_within_bounds())
      return;

    const NodeRanges  all = {{0, n_nodes}};
    std::vector<char> is_fixed(n_values);
    for (unsigned int turn = 0; turn < 10; ++turn)
      {
        std::copy_n(c, n_values, step);
        relax_within_bounds(0, all);
        relax_within_bounds(0, all);
        std::array<double, 2> change_and_size{};
        for (unsigned int i = 0; i < n_values; ++i)
          {
            change_and_size[0] =
              std::max(change_and_size[0], std::abs(c[i] - step[i]));
            change_and_size[1] = std::max(change_and_size[1], std::abs(c[i]));
          }
        change_and_size =
          max_over_processes(change_and_size, levels.communicator());
        if (change_and_size[0] <= 1e-6 * change_and_size[1])
          break;
        B.residual(r, rhs[0].begin(), c);
        for (unsigned int i = 0; i < n_values; ++i)
          is_fixed[i] = (c[i] <= lo[i] || c[i] >= up[i]);
        levels.coarsest_solver().solve_on_face(step, r, is_fixed);
        step_within_bounds();
      }
  }



  template <int dim>
  std::size_t
  MonotoneCorrection<dim>::memory_consumption() const
  {
    std::size_t bytes = Base::memory_consumption() +
      leaf_lower.memory_consumption() + leaf_upper.memory_consumption() +
      coarsest_step.memory_consumption();
    for (const auto &vectors : {&lower, &upper})
      for (const VectorType &vector : *vectors)
        bytes += vector.memory_consumption();
    for (const std::vector<double> &bounds : restricted)
      bytes += bounds.capacity() * sizeof(double);
    return bytes;
  }



  template class MonotoneCorrection<2>;
  template class MonotoneCorrection<3>;
} // namespace Friction
