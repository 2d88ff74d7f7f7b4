#include <common/parallel/owned_values.h>
#include <common/parallel/phase_costs.h>
#include <common/parallel/reductions.h>
#include <common/solvers/monotone_multigrid.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace Friction
{
  namespace
  {
    // Steps that have to be shortened to less than this are suspicious.
    constexpr double short_step = .1;



    // The increments that are still to come, if they go on as the last two:
    // each iterate differs from the one before by an increment, and from the
    // solution by all that follow. The pace is not believed to be better than a
    // tenth per cycle, nor, so that the sum is finite, slower than 0.98.
    double
    extrapolated_error(const std::vector<CycleInfo> &cycles)
    {
      const double last = cycles.back().increment;
      if (cycles.size() < 2 || !(cycles[cycles.size() - 2].increment > 0))
        return last;
      const double pace =
        std::max(.1, std::min(.98, last / cycles[cycles.size() - 2].increment));
      return last * pace / (1 - pace);
    }



    // Adds the time until its end to a counter; what is sent until then counts
    // for the same part of the work.
    class Stopwatch
    {
    public:
      Stopwatch(double &seconds, const SolverPhase phase)
        : communication(phase)
        , seconds(seconds)
        , start(std::chrono::steady_clock::now())
      {}

      ~Stopwatch()
      {
        seconds += std::chrono::duration<double>(
                     std::chrono::steady_clock::now() - start)
                     .count();
      }

    private:
      const PhaseScope                            communication;
      double                                     &seconds;
      const std::chrono::steady_clock::time_point start;
    };
  } // namespace



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
                          const unsigned int maximum_cycles) const
  {
    constexpr unsigned int window = 20;
    const unsigned int     n      = cycles.size();
    if (n < 50)
      return false;
    const auto smallest = [&](const unsigned int end) {
      double result = cycles[end - window].increment;
      for (unsigned int i = end - window; i < end; ++i)
        result = std::min(result, cycles[i].increment);
      return result;
    };
    const double now  = smallest(n);
    const double rate = std::pow(now / smallest(n - window), 1. / window);
    return !(rate < 1) ||
      std::log(tolerance / now) / std::log(rate) > double(maximum_cycles) - n;
  }



  template <int dim>
  MonotoneMultigrid<dim>::MonotoneMultigrid(
    const LevelHierarchy<dim>  &hierarchy,
    const DiscreteProblem<dim> &problem,
    const SolverSettings       &settings)
    : problem(problem)
    , settings(settings)
    , functional(problem)
    , smoother(problem.matrix,
               problem.constraints,
               problem.contact,
               problem.effective_coefficient(),
               settings.local_solver)
    , linearization(problem.matrix,
                    problem.constraints,
                    problem.contact,
                    problem.effective_coefficient(),
                    settings.truncation)
  {
    if (settings.coarse_correction == CoarseCorrection::algebraic)
      algebraic = std::make_unique<AlgebraicCorrection<dim>>(
        problem.matrix, problem.constraints, settings.coarsest_method);
    else
      coarse =
        std::make_unique<CoarseCycle<dim>>(problem.matrix,
                                           hierarchy,
                                           problem.constraints,
                                           settings.cycle,
                                           settings.coarse_smoothing_steps,
                                           settings.coarsest_method);
  }



  // A body that merely moves has no energy but that of rounding errors, with
  // which no increment should be compared. The diagonal of the matrix says what
  // energy a displacement of this size could have.
  template <int dim>
  double
  MonotoneMultigrid<dim>::smallest_norm(const VectorType &u) const
  {
    double sum = 0;
    for (unsigned int i = 0; i < problem.matrix.n_rows(); ++i)
      if (problem.matrix.row_begin(i) < problem.matrix.row_end(i))
        sum += trace<dim>(problem.matrix.block(problem.matrix.row_begin(i))) *
          dot<dim>(u.begin() + dim * i, u.begin() + dim * i);
    return std::max(1e-12 * sum_over_processes(sum, problem.communicator()),
                    1e-300);
  }



  template <int dim>
  void
  MonotoneMultigrid<dim>::set_normal_forces(ContactState     &state,
                                            const VectorType &residual) const
  {
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      state.set_normal_force(
        p,
        state.in_contact(p)
          ? std::max(0., normal_component(problem.contact[p], residual))
          : 0.);
  }



  template <int dim>
  VectorType
  MonotoneMultigrid<dim>::update_normal_forces(ContactState     &state,
                                               const VectorType &u) const
  {
    VectorType residual(u);
    problem.matrix.residual(
      residual.begin(), problem.forces.begin(), u.begin());
    set_normal_forces(state, residual);
    return residual;
  }



  template <int dim>
  MultigridResult
  MonotoneMultigrid<dim>::solve(VectorType     &u,
                                ContactState   &state,
                                const bool      update_normal_forces,
                                const Progress &progress)
  {
    const Stopwatch    stopwatch(costs.total, SolverPhase::other);
    MultigridResult    result;
    Recombination<dim> recombination(settings.recombined_steps);
    VectorType         residual(u), last_u, last_residual;
    double             floor_of_norm = 0;
    const bool         update = update_normal_forces && problem.has_friction();
    smoother.ghosts().update(u.begin(), dim);

    for (unsigned int cycle = 0;; ++cycle)
      {
        {
          const Stopwatch sweeps(costs.leading_sweeps,
                                 SolverPhase::leading_sweeps);

          // The very first sweep works with the normal forces of the initial
          // guess, which know better than its residual does.
          typename MonotoneSmoother<dim>::Sweeps what;
          what.n                         = settings.smoothing_steps;
          what.update_normal_forces      = update;
          what.trust_first_normal_forces = (cycle == 0);
          smoother.sweeps(u, problem.forces, state, what, &residual);
          costs.n_leading_sweeps += settings.smoothing_steps + 1;
        }
        if (update)
          set_normal_forces(state, residual);

        // The increment from one smoothed iterate to the next, in the energy
        // norm: A times it is a difference of residuals. What has to be summed
        // over all processes goes together.
        enum Sum
        {
          increment,
          norm,
          energy
        };
        std::array<double, 3> sums{};
        for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
          {
            if (cycle > 0)
              sums[increment] +=
                (u.local_element(i) - last_u.local_element(i)) *
                (last_residual.local_element(i) - residual.local_element(i));
            sums[norm] += u.local_element(i) *
              (problem.forces.local_element(i) - residual.local_element(i));
          }
        sums[energy] = functional.energy_share(u, residual, state);
        sums         = sum_over_processes(sums, problem.communicator());
        if (cycle > 0)
          {
            if (cycle == 1)
              floor_of_norm = smallest_norm(u);
            CycleInfo &info = result.cycles.back();
            info.increment  = std::sqrt(std::max(0., sums[increment]) /
                                       std::max(sums[norm], floor_of_norm));
            if (progress)
              progress(cycle, info.increment);
            if (!std::isfinite(info.increment))
              break;
            result.algebraic_error =
              std::sqrt(std::max(sums[norm], floor_of_norm)) *
              extrapolated_error(result.cycles);
            if (info.increment <= settings.inner_tolerance ||
                (cycle > 1 &&
                 result.algebraic_error <= settings.energy_tolerance))
              {
                result.converged = true;
                break;
              }
            if (cycle >= settings.maximum_cycles)
              break;
            if (settings.gives_up_early &&
                result.stalls(
                  std::max(settings.inner_tolerance,
                           settings.energy_tolerance /
                             std::sqrt(std::max(sums[norm], floor_of_norm))),
                  settings.maximum_cycles))
              break;
          }
        last_u        = u;
        last_residual = residual;

        CycleInfo info = {};
        info.energy    = sums[energy];
        info.damping   = correct(u, residual, state, recombination, info);
        result.cycles.push_back(info);

        const Stopwatch                        sweeps(costs.leading_sweeps,
                               SolverPhase::leading_sweeps);
        typename MonotoneSmoother<dim>::Sweeps what;
        what.n                    = settings.smoothing_steps;
        what.backwards            = true;
        what.update_normal_forces = update;
        smoother.sweeps(u, problem.forces, state, what);
        costs.n_leading_sweeps += settings.smoothing_steps;
      }
    return result;
  }



  // Parts two to five of a step. Returns the step length.
  template <int dim>
  double
  MonotoneMultigrid<dim>::correct(VectorType         &u,
                                  const VectorType   &residual,
                                  const ContactState &state,
                                  Recombination<dim> &recombination,
                                  CycleInfo          &info)
  {
    {
      const Stopwatch updates(costs.matrix_updates,
                              SolverPhase::matrix_updates);
      linearization.update(u, state);
      if (algebraic)
        algebraic->update(linearization.truncation());
      else
        costs.n_updated_rows += coarse->update(linearization.truncation());
    }

    VectorType r(residual), v(u);
    linearization.linearize_residual(r, u, state);
    std::array<double, 2> totals{
      {0., 1. * linearization.truncation().n_truncated_components()}};
    for (unsigned int i = 0; i < r.locally_owned_size(); ++i)
      totals[0] += r.local_element(i) * r.local_element(i);
    totals         = sum_over_processes(totals, problem.communicator());
    info.residual  = std::sqrt(totals[0]);
    info.truncated = totals[1];

    if (settings.coarse_correction == CoarseCorrection::monotone)
      {
        // Admissible, within the phases, and in two dimensions lowering the
        // energy as it is: no line search. Only rounding is projected away.
        const Stopwatch work(costs.coarse_correction, SolverPhase::transfer);
        VectorType      lower(u), upper(u);
        linearization.bounds(lower, upper, u, state);
        coarse->apply_within_bounds(v, r, lower, upper);
        functional.project(v, u);
        add_owned(u, 1., v);
        smoother.ghosts().update(u.begin(), dim);
        return 1.;
      }

    {
      const Stopwatch work(costs.coarse_correction, SolverPhase::transfer);
      if (algebraic)
        algebraic->apply(v, r);
      else
        coarse->apply(v, r);
    }

    const Stopwatch work(costs.line_search, SolverPhase::line_search);
    VectorType      Av(u);
    multiply(Av, v);
    recombination.add_iterate(u, residual);
    recombination.improve(v, Av, r, linearization.truncation());

    // Where a node would have to reverse its slip, the linearisation knows
    // nothing of what comes. A single such node would hold up all others in the
    // line search; it rather stops, and the relaxation decides how it goes on.
    const VectorType   whole(v);
    const unsigned int n_stopped = functional.keep_slip(v, u, state);
    Products           products  = along(v, Av, residual, n_stopped);
    const bool         stopped   = products.n_changed > 0;
    if (stopped)
      {
        multiply(Av, v);
        products = along(v, Av, residual, 0);
      }
    if (!(products.curvature > 0))
      return 0.;
    double length = functional.minimize_along(v,
                                              u,
                                              state,
                                              products.slope,
                                              products.curvature,
                                              settings.maximum_damping);
    scale_owned(v, length);
    const bool cut_off =
      true_on_any_process(functional.project(v, u) > 0, problem.communicator());
    if (cut_off)
      {
        // The obstacle has cut the correction off: minimise along what is left
        // of it, as far as that is admissible.
        multiply(Av, v);
        products          = along(v, Av, residual, 0);
        const double rest = functional.minimize_along(
          v,
          u,
          state,
          products.slope,
          products.curvature,
          functional.admissible_length(v, u, settings.maximum_damping));
        scale_owned(v, rest);
        length *= rest;
      }
    if (length < short_step && (cut_off || stopped))
      length = try_whole_correction(v, length, whole, u, residual, state);
    add_owned(u, 1., v);
    smoother.ghosts().update(u.begin(), dim);
    return length;
  }



  // A correction that turns a long thin body around one end of its contact
  // boundary, and that has been changed at the other end, is no longer a
  // rotation, and the body is far too stiff for what it has become: hardly
  // anything is left of it. It is better to go all of it, but only until the
  // next node touches; the line search knows what it costs that nodes reverse
  // their slip. Of the two steps the one is taken that lowers the energy more.
  //
  // On call v is the first step and length what it is of its correction; on
  // return they are those of the better step.
  template <int dim>
  double
  MonotoneMultigrid<dim>::try_whole_correction(VectorType         &v,
                                               const double        length,
                                               const VectorType   &whole,
                                               const VectorType   &u,
                                               const VectorType   &residual,
                                               const ContactState &state) const
  {
    VectorType other(whole), Av(v), moved(v), r(v);
    multiply(Av, other);
    const Products products     = along(other, Av, residual, 0);
    const double   other_length = functional.minimize_along(
      other,
      u,
      state,
      products.slope,
      products.curvature,
      functional.admissible_length(other, u, settings.maximum_damping));
    scale_owned(other, other_length);
    functional.project(other, u);

    const auto energy_after = [&](VectorType &step) {
      multiply(Av, step);
      moved = u;
      add_owned(moved, 1., step);
      r = residual;
      add_owned(r, -1., Av);
      return functional.energy(moved, r, state);
    };
    if (!(energy_after(other) < energy_after(v)))
      return length;
    v = other;
    return other_length;
  }



  template <int dim>
  void
  MonotoneMultigrid<dim>::multiply(VectorType &Av, VectorType &v) const
  {
    smoother.ghosts().update(v.begin(), dim);
    problem.matrix.vmult(Av.begin(), v.begin());
  }



  template <int dim>
  typename MonotoneMultigrid<dim>::Products
  MonotoneMultigrid<dim>::along(const VectorType  &v,
                                const VectorType  &Av,
                                const VectorType  &residual,
                                const unsigned int n_changed) const
  {
    std::array<double, 3> sums{{0., 0., 1. * n_changed}};
    for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
      {
        sums[0] += residual.local_element(i) * v.local_element(i);
        sums[1] += v.local_element(i) * Av.local_element(i);
      }
    sums = sum_over_processes(sums, problem.communicator());
    return {sums[0], sums[1], static_cast<std::size_t>(sums[2])};
  }



  template <int dim>
  std::size_t
  MonotoneMultigrid<dim>::memory_consumption() const
  {
    return smoother.memory_consumption() +
      (algebraic ? algebraic->memory_consumption()
                 : coarse->memory_consumption());
  }



  template class MonotoneMultigrid<2>;
  template class MonotoneMultigrid<3>;
} // namespace Friction
