#include <common/solvers/monotone_multigrid.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace Friction
{
  namespace
  {
    // Adds the time until its end to a counter.
    class Stopwatch
    {
    public:
      explicit Stopwatch(double &seconds)
        : seconds(seconds)
        , start(std::chrono::steady_clock::now())
      {}

      ~Stopwatch()
      {
        seconds += std::chrono::duration<double>(
                     std::chrono::steady_clock::now() - start)
                     .count();
      }

    private:
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



  template <int dim>
  MonotoneMultigrid<dim>::MonotoneMultigrid(
    const DoFHandler<dim>      &dof_handler,
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
    , coarse(dof_handler,
             problem.matrix,
             hierarchy,
             problem.constraints,
             settings.cycle,
             settings.coarse_smoothing_steps,
             settings.coarsest_method)
  {}



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
    return std::max(1e-12 * sum, 1e-300);
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
    const Stopwatch    stopwatch(costs.total);
    MultigridResult    result;
    Recombination<dim> recombination(settings.recombined_steps);
    VectorType         residual(u), last_u, last_residual;
    double             floor_of_norm = 0;
    const bool         update = update_normal_forces && problem.has_friction();

    for (unsigned int cycle = 0;; ++cycle)
      {
        {
          const Stopwatch sweeps(costs.leading_sweeps);

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
        // norm: A times it is a difference of residuals.
        if (cycle > 0)
          {
            if (cycle == 1)
              floor_of_norm = smallest_norm(u);
            double increment = 0, norm = 0;
            for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
              {
                increment += (u.local_element(i) - last_u.local_element(i)) *
                  (last_residual.local_element(i) - residual.local_element(i));
                norm += u.local_element(i) *
                  (problem.forces.local_element(i) - residual.local_element(i));
              }
            CycleInfo &info = result.cycles.back();
            info.increment  = std::sqrt(std::max(0., increment) /
                                       std::max(norm, floor_of_norm));
            if (progress)
              progress(cycle, info.increment);
            if (!std::isfinite(info.increment))
              break;
            if (info.increment <= settings.inner_tolerance)
              {
                result.converged = true;
                break;
              }
            if (cycle >= settings.maximum_cycles)
              break;
          }
        last_u        = u;
        last_residual = residual;

        CycleInfo info = {};
        info.energy    = functional.energy(u, residual, state);
        info.damping   = correct(u, residual, state, recombination, info);
        result.cycles.push_back(info);

        const Stopwatch                        sweeps(costs.leading_sweeps);
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
      const Stopwatch updates(costs.matrix_updates);
      linearization.update(u, state);
      costs.n_updated_rows += coarse.update(linearization.truncation());
    }

    VectorType r(residual), v(u);
    linearization.linearize_residual(r, u, state);
    info.residual  = r.l2_norm();
    info.truncated = linearization.truncation().n_truncated_components();

    if (settings.coarse_correction == CoarseCorrection::monotone)
      {
        // Admissible, within the phases, and in two dimensions lowering the
        // energy as it is: no line search. Only rounding is projected away.
        const Stopwatch work(costs.coarse_correction);
        VectorType      lower(u), upper(u);
        linearization.bounds(lower, upper, u, state);
        coarse.apply_within_bounds(v, r, lower, upper);
        functional.project(v, u);
        u += v;
        return 1.;
      }

    {
      const Stopwatch work(costs.coarse_correction);
      coarse.apply(v, r);
    }

    const Stopwatch work(costs.line_search);
    VectorType      Av(u);
    problem.matrix.vmult(Av.begin(), v.begin());
    recombination.add_iterate(u, residual);
    recombination.improve(v, Av, r, linearization.truncation());

    // Where a node would have to reverse its slip, the linearisation knows
    // nothing of what comes. A single such node would hold up all others in the
    // line search; it rather stops, and the relaxation decides how it goes on.
    if (functional.keep_slip(v, u, state) > 0)
      problem.matrix.vmult(Av.begin(), v.begin());
    double curvature = v * Av;
    if (!(curvature > 0))
      return 0.;
    double length = functional.minimize_along(
      v, u, state, residual * v, curvature, settings.maximum_damping);
    v *= length;
    if (functional.project(v, u) > 0)
      {
        // The obstacle has cut the correction off: minimise along what is left
        // of it, as far as that is admissible.
        problem.matrix.vmult(Av.begin(), v.begin());
        const double rest = functional.minimize_along(
          v,
          u,
          state,
          residual * v,
          v * Av,
          functional.admissible_length(v, u, settings.maximum_damping));
        v *= rest;
        length *= rest;
      }
    u += v;
    return length;
  }



  template <int dim>
  std::size_t
  MonotoneMultigrid<dim>::memory_consumption() const
  {
    return smoother.memory_consumption() + coarse.memory_consumption();
  }



  template class MonotoneMultigrid<2>;
  template class MonotoneMultigrid<3>;
} // namespace Friction
