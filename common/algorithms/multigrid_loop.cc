#include <common/algorithms/multigrid_loop.h>
#include <common/parallel/owned_values.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Friction
{
  namespace
  {
    // The increments that are still to come, if they go on as the last two:
    // each iterate differs from the one before by an increment, and from the
    // solution by all that follow. A single increment goes on as expected, or
    // else by halves. The pace is not believed to be better than a tenth per
    // cycle, nor, so that the sum is finite, slower than 0.98.
    double
    extrapolated_error(const std::vector<CycleInfo> &cycles,
                       const double                  expected_pace)
    {
      const double last = cycles.back().increment;
      double       pace = expected_pace > 0 ? expected_pace : .5;
      if (cycles.size() > 1 && cycles[cycles.size() - 2].increment > 0)
        pace = last / cycles[cycles.size() - 2].increment;
      pace = std::max(.1, std::min(.98, pace));
      return last * pace / (1 - pace);
    }



    // How many cycles it takes from the increment @p now to @p tolerance at
    // this pace per cycle.
    double
    cycles_at_pace(const double pace, const double now, const double tolerance)
    {
      return pace < 1 ? std::max(0., std::log(tolerance / now) / std::log(pace))
                      : std::numeric_limits<double>::infinity();
    }



    // Whether increments are nothing but rounding errors: they are as small,
    // and no longer become smaller. A tolerance below that can only be met so.
    bool
    is_rounding(const std::vector<CycleInfo> &cycles)
    {
      constexpr double       largest = 1e-12;
      constexpr unsigned int window  = 4;
      const std::size_t      n       = cycles.size();
      if (n <= window || cycles[n - 1 - window].increment > largest)
        return false;
      for (std::size_t i = n - window; i < n; ++i)
        if (cycles[i].increment < .5 * cycles[n - 1 - window].increment)
          return false;
      return cycles.back().increment > .9 * cycles[n - 1 - window].increment;
    }



    // Whether more components are held in each of the last cycles than in each
    // of as many before, or fewer, and the last ones have changed their number
    // by one per cycle.
    bool
    contact_zone_spreads(const std::vector<CycleInfo> &cycles,
                         const unsigned int            n_last)
    {
      const auto less = [](const CycleInfo &a, const CycleInfo &b) {
        return a.truncated < b.truncated;
      };
      const auto last   = cycles.end() - n_last;
      const auto now    = std::minmax_element(last, cycles.end(), less);
      const auto before = std::minmax_element(last - n_last, last, less);
      return (less(*before.second, *now.first) ||
              less(*now.second, *before.first)) &&
        std::abs(cycles.back().truncated - last->truncated) >= n_last;
    }
  } // namespace



  template <int dim>
  double
  smallest_squared_norm(const DiscreteProblem<dim> &problem,
                        const VectorType           &u)
  {
    const NodeBlockMatrix<dim> &A   = problem.stiffness.blocks();
    double                      sum = 0;
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      if (!A.is_empty(i))
        sum += trace<dim>(A.diagonal(i)) *
          dot<dim>(u.begin() + dim * i, u.begin() + dim * i);
    return std::max(1e-12 * sum_over_processes(sum, problem.communicator()),
                    1e-300);
  }



  double
  MultigridResult::contraction() const
  {
    if (cycles.size() < 2 || !(cycles.front().increment > 0))
      return 0.;
    return std::pow(cycles.back().increment / cycles.front().increment,
                    1. / (cycles.size() - 1));
  }



  bool
  MultigridResult::stalls(const double       tolerance,
                          const unsigned int maximum_cycles,
                          const unsigned int patience) const
  {
    Assert(patience >= 5, ExcMessage("There is nothing to compare."));
    const unsigned int window = 2 * patience / 5;
    const unsigned int n      = cycles.size();
    if (n < patience || contact_zone_spreads(cycles, window))
      return false;
    const auto smallest = [&](const unsigned int end) {
      double result = cycles[end - window].increment;
      for (unsigned int i = end - window; i < end; ++i)
        result = std::min(result, cycles[i].increment);
      return result;
    };
    const double now  = smallest(n);
    const double rate = std::pow(now / smallest(n - window), 1. / window);
    return cycles_at_pace(rate, now, tolerance) > double(maximum_cycles) - n;
  }



  bool
  MultigridResult::phases_have_settled() const
  {
    constexpr unsigned int window = 4;
    const std::size_t      n      = cycles.size();
    for (unsigned int i = 1; i <= window; ++i)
      if (n < i || cycles[n - i].truncated != cycles.back().truncated)
        return false;
    return true;
  }



  double
  MultigridResult::cycles_until(const double tolerance) const
  {
    constexpr unsigned int window = 4;
    const std::size_t      n      = cycles.size();
    if (n <= window)
      return 0.;
    const double now = cycles.back().increment;
    const double rate =
      std::pow(now / cycles[n - 1 - window].increment, 1. / window);
    return cycles_at_pace(rate, now, tolerance);
  }



  template <int dim>
  MultigridResult
  run_multigrid(MonotoneMultigrid<dim> &iteration,
                Iterate                &x,
                const MultigridLimits  &limits,
                const Progress         &progress)
  {
    const DiscreteProblem<dim> &problem = iteration.problem();
    const unsigned int          n_dofs  = x.u.locally_owned_size();
    MultigridResult             result;

    // What has to be summed over all processes goes together: the squares of
    // the last increment, of the iterate and of the truncated residual, the
    // energy, and the number of truncated components.
    enum Sum
    {
      increment,
      norm,
      energy,
      residual,
      truncated,
      n_sums
    };
    std::array<double, n_sums> sums;
    const auto                 look_at_iterate = [&]() {
      const bool first = result.cycles.empty();
      sums.fill(0.);
      const double *u = x.u.begin(), *r = x.residual.begin(),
                   *f = problem.forces.begin();
      sums[norm]      = sum_of_terms(
        n_dofs, [=](const unsigned int i) { return u[i] * (f[i] - r[i]); });
      sums[energy] =
        iteration.functional().energy_share(x.u, x.residual, x.state);
      if (!first)
        {
          sums[increment] = dot_owned(x.step, x.step_image);
          sums[residual] = dot_owned(iteration.truncated_residual(),
                                     iteration.truncated_residual());
          sums[truncated] = iteration.truncation().n_truncated_components();
        }
      sums = sum_over_processes(sums, problem.communicator());
    };

    iteration.begin(x);
    look_at_iterate();
    double             floor_of_norm = 0;
    const unsigned int worthwhile =
      std::min(limits.maximum_cycles, limits.worthwhile_cycles);
    for (unsigned int cycle = 1;; ++cycle)
      {
        CycleInfo info   = {};
        info.energy      = sums[energy];
        info.step_length = iteration.iterate(x);
        result.cycles.push_back(info);

        look_at_iterate();
        if (cycle == 1)
          floor_of_norm = smallest_squared_norm(problem, x.u);
        const double squared_size = std::max(sums[norm], floor_of_norm);
        const double size         = std::sqrt(squared_size);
        CycleInfo   &last         = result.cycles.back();
        last.increment =
          std::sqrt(std::max(0., sums[increment]) / squared_size);
        last.residual  = std::sqrt(sums[residual]);
        last.truncated = sums[truncated];
        if (progress)
          progress(cycle, last.increment);
        if (limits.budget)
          limits.budget->take_cycle();
        if (!std::isfinite(last.increment))
          break;
        result.algebraic_error =
          size * extrapolated_error(result.cycles, limits.expected_pace);
        if (last.increment <= limits.inner_tolerance ||
            is_rounding(result.cycles) ||
            ((cycle > 1 || limits.expected_pace > 0) &&
             result.algebraic_error <= limits.energy_tolerance))
          {
            result.converged = true;
            break;
          }
        const double tolerance =
          std::max(limits.inner_tolerance, limits.energy_tolerance / size);
        if (cycle >= limits.maximum_cycles ||
            (limits.budget && limits.budget->is_spent()))
          break;
        if (limits.finish && result.phases_have_settled() &&
            limits.finish(cycle, result.cycles_until(tolerance)))
          {
            result.converged = true;
            break;
          }
        if ((limits.budget && limits.budget->is_spent()) ||
            (limits.patience > 0 &&
             result.stalls(tolerance, worthwhile, limits.patience)))
          break;
      }
    return result;
  }



  template double smallest_squared_norm(const DiscreteProblem<2> &,
                                        const VectorType &);
  template double smallest_squared_norm(const DiscreteProblem<3> &,
                                        const VectorType &);

  template MultigridResult run_multigrid(MonotoneMultigrid<2> &,
                                         Iterate &,
                                         const MultigridLimits &,
                                         const Progress &);
  template MultigridResult run_multigrid(MonotoneMultigrid<3> &,
                                         Iterate &,
                                         const MultigridLimits &,
                                         const Progress &);
} // namespace Friction
