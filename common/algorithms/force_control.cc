#include <common/algorithms/force_control.h>
#include <common/algorithms/initial_guess.h>
#include <common/contact/contact_forces.h>
#include <common/contact/force_balance.h>
#include <common/dense_algebra.h>
#include <common/input_error.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace Friction
{
  namespace
  {
    constexpr unsigned int maximum_positions = 60;

    // By what factor the compliance may grow in one step, and a step with it.
    constexpr double growth = 10.;

    // Relative increments of a rough solution: the first number at most, and
    // this share of what is missing of the forces. Forces are believed to be
    // wrong by as much, which is true if an iteration does not converge slowly;
    // where it is not, see below.
    constexpr double rough = 3e-3, rough_share = .2;

    // A force that is known like this, relatively, is found, however small the
    // error is that has been asked for.
    constexpr double well_known = 1e-6;

    // A force cannot be better known than to this part of the largest one that
    // the search has met: so much do rounding errors of positions change it.
    constexpr double rounding = 1e-13;

    // Part of the largest stiffness times the largest displacement that is no
    // force at a node, if all forces are as small.
    constexpr double rounding_of_nothing = 1e-13;

    // A trial that does not converge is taken back in part, so many times.
    constexpr unsigned int maximum_retreats = 3;



    // Where a single position is, as far as it is known: the force grows with
    // it. Of several there is nothing to enclose.
    class Bracket
    {
    public:
      template <typename Sample>
      void
      add(const Sample &sample)
      {
        if (sample.positions.size() != 1)
          return;
        const double position = sample.positions[0];
        const bool   is_lower = sample.missing[0] > 0;
        End         &end      = is_lower ? lower : upper;
        if (is_lower ? position >= end.position : position <= end.position)
          end = {position, sample.accuracy > 0.};
      }

      // What rough solutions have said.
      void
      forget_rough_ends()
      {
        if (lower.is_rough)
          lower = Bracket().lower;
        if (upper.is_rough)
          upper = Bracket().upper;
      }

      // The position to be tried next: the one that is proposed, unless it is
      // outside, or proposals have not been of use.
      double
      next(const double proposed, const bool is_useless) const
      {
        const double from = lower.position, to = upper.position;
        const bool   is_closed = std::isfinite(from) && std::isfinite(to);
        const bool   is_inside = proposed > from && proposed < to;
        return is_closed && (!is_inside || is_useless) ? .5 * (from + to)
                                                       : proposed;
      }

    private:
      struct End
      {
        double position;
        bool   is_rough;
      };

      End lower = {-std::numeric_limits<double>::infinity(), false},
          upper = {std::numeric_limits<double>::infinity(), false};
    };
  } // namespace



  template <int dim>
  ForceControl<dim>::ForceControl(Scene<dim> &scene)
    : scene(scene)
  {
    const auto &conditions = scene.dirichlet_conditions();
    for (unsigned int i = 0; i < conditions.size(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        if (conditions[i].platen != nullptr &&
            conditions[i].platen->is_controlled[d])
          controls.push_back({i, d});
  }



  template <int dim>
  Eigen::VectorXd
  ForceControl<dim>::positions() const
  {
    Eigen::VectorXd s(controls.size());
    for (unsigned int j = 0; j < controls.size(); ++j)
      s[j] = (*scene.dirichlet_conditions()[controls[j].condition]
                 .platen->position)[controls[j].component];
    return s;
  }



  template <int dim>
  void
  ForceControl<dim>::move_to(const Eigen::VectorXd &s)
  {
    for (unsigned int j = 0; j < controls.size(); ++j)
      {
        const unsigned int condition = controls[j].condition;
        Tensor<1, dim>     position =
          *scene.dirichlet_conditions()[condition].platen->position;
        position[controls[j].component] = s[j];
        scene.move_platen(condition, position);
      }
  }



  template <int dim>
  Eigen::VectorXd
  ForceControl<dim>::given_forces() const
  {
    Eigen::VectorXd forces(controls.size());
    for (unsigned int j = 0; j < controls.size(); ++j)
      forces[j] = scene.dirichlet_conditions()[controls[j].condition]
                    .platen->force->value(Point<dim>(), controls[j].component);
    return forces;
  }



  // A node that an earlier condition holds would not move with the platen.
  template <int dim>
  typename ForceControl<dim>::PlatenDofs
  ForceControl<dim>::find_dofs(const Discretization<dim> &discretization) const
  {
    const NodalConstraints<dim>    &constraints = discretization.constraints();
    const std::vector<unsigned int> holders     = find_holders(discretization);
    const auto                     &conditions  = scene.dirichlet_conditions();
    const auto                      nodes = nodes_of_conditions(discretization);
    PlatenDofs                      dofs(controls.size());
    std::vector<double>             n_held(2 * controls.size(), 0.);
    for (unsigned int j = 0; j < controls.size(); ++j)
      for (const unsigned int node : nodes[controls[j].condition])
        if (!constraints.is_hanging(node))
          {
            const unsigned int i = dim * node + controls[j].component;
            if (holders[i] == controls[j].condition)
              {
                dofs[j].push_back(i);
                n_held[2 * j] = 1;
              }
            else
              n_held[2 * j + 1] = 1;
          }
    max_over_processes(n_held, constraints.communicator());
    for (unsigned int j = 0; j < controls.size(); ++j)
      if (n_held[2 * j] == 0 || n_held[2 * j + 1] > 0)
        throw InputError(
          scene.subject() + "'Boundary conditions/Force', boundary " +
          std::to_string(conditions[controls[j].condition].boundary_id) +
          ": a part of it has its displacement in component " +
          std::to_string(controls[j].component + 1) +
          " from another boundary or point, so that it cannot be moved as a "
          "whole; leave that component 'free' there.");
    return dofs;
  }



  namespace
  {
    // Of the values of v at these degrees of freedom, on all processes.
    Eigen::VectorXd
    sums_over(const std::vector<std::vector<unsigned int>> &dofs,
              const VectorType                             &v,
              const MPI_Comm                                communicator)
    {
      Eigen::VectorXd sums(dofs.size());
      for (unsigned int j = 0; j < dofs.size(); ++j)
        {
          double sum = 0;
          for (const unsigned int i : dofs[j])
            sum += v.local_element(i);
          sums[j] = sum_over_processes(sum, communicator);
        }
      return sums;
    }



    // The force of the obstacles, and that of the loads: what the body bears
    // besides the reactions of platens.
    template <int dim>
    double
    other_forces(const Discretization<dim> &discretization,
                 const VectorType          &residual)
    {
      std::array<double, 2> sums{};
      for (const ContactNode<dim> &node : discretization.contact())
        sums[0] += contact_force(node, residual).norm();
      const VectorType &loads = discretization.loads();
      for (unsigned int i = 0; i < loads.locally_owned_size(); ++i)
        sums[1] += std::abs(loads.local_element(i));
      sums =
        sum_over_processes(sums, discretization.constraints().communicator());
      return std::max(sums[0], sums[1]);
    }
  } // namespace



  // The matrix with the entries e_i^T A e_j, inverted. It is positive definite:
  // no e_j is a rigid motion, or there would be nothing to press against.
  template <int dim>
  void
  ForceControl<dim>::begin_with_stiffness_of_body(
    const Discretization<dim> &discretization, const PlatenDofs &dofs)
  {
    Eigen::MatrixXd stiffness(controls.size(), controls.size());
    VectorType      e = discretization.vector(), Ae = e;
    for (unsigned int j = 0; j < controls.size(); ++j)
      {
        e = 0.;
        for (const unsigned int i : dofs[j])
          e.local_element(i) = 1.;
        discretization.stiffness().vmult(Ae, e);
        stiffness.col(j) =
          sums_over(dofs, Ae, discretization.constraints().communicator());
      }
    compliance = inverse(stiffness);
  }



  // Broyden's update, that of the inverse by the formula of Sherman and
  // Morrison. It is damped, in the way of Powell, where the compliance along
  // the last step would change its sign or grow by more than a factor.
  template <int dim>
  void
  ForceControl<dim>::learn(const Sample &before, const Sample &now)
  {
    const Eigen::VectorXd step   = now.positions - before.positions;
    const double          length = step.squaredNorm();
    if (length == 0.)
      return;
    Eigen::VectorXd predicted = compliance * (now.forces - before.forces);
    const double    ratio     = step.dot(predicted) / length;
    if (ratio < 1. / growth)
      {
        const double damping = (1. - 1. / growth) / (1. - ratio);
        predicted            = damping * predicted + (1. - damping) * step;
      }
    const Eigen::RowVectorXd row = step.transpose() * compliance;
    compliance += (step - predicted) * row / step.dot(predicted);
  }



  template <int dim>
  void
  ForceControl<dim>::give_up(const Sample &nearest) const
  {
    std::ostringstream text;
    for (unsigned int j = 0; j < controls.size(); ++j)
      {
        const auto &condition =
          scene.dirichlet_conditions()[controls[j].condition];
        text << (j == 0 ? "" : "; ") << "component "
             << controls[j].component + 1 << " on boundary "
             << condition.boundary_id << " is " << nearest.forces[j]
             << " instead of " << wanted[j] << ", where it has been moved by "
             << nearest.positions[j];
      }
    throw InputError(
      scene.subject_at_time() +
      "the forces of 'Boundary conditions/Force' cannot be reached; nearest to "
      "them " +
      text.str() +
      ". Can contact and friction bear them? Leave components 'free' in which "
      "nothing bears a force, and let 'Displacement' begin in contact, with "
      "forces not far larger than these.");
  }



  template <int dim>
  SolverReport
  ForceControl<dim>::solve(Discretization<dim>  &discretization,
                           VectorType           &u,
                           ContactState         &state,
                           const SolverSettings &settings,
                           const SolveOnce      &solve_once)
  {
    if (controls.empty())
      return solve_once(0.);

    const MPI_Comm   communicator = discretization.constraints().communicator();
    const PhaseCosts costs_before = phase_costs(communicator);
    const PlatenDofs dofs         = find_dofs(discretization);
    const double     body_size    = discretization.body_size();
    const unsigned int n          = controls.size();
    const double       tolerance  = settings.certificate_tolerance;
    const bool         may_be_rough = rough > tolerance;
    double accuracy = compliance.size() > 0 && may_be_rough ? rough : 0.;
    if (compliance.size() == 0)
      begin_with_stiffness_of_body(discretization, dofs);
    wanted                   = given_forces();
    SolverReport report      = solve_once(accuracy);
    unsigned int n_positions = 1, n_poor = 0;
    double       largest_force = 0.;

    // The residual is what is left of the loads; the force of what holds the
    // body is opposite to it. The energy that has been asked for is that of the
    // difference of two solutions: the force that is missing times the way that
    // it needs.
    const auto sample = [&]() {
      Sample result;
      result.positions    = positions();
      result.forces       = -sums_over(dofs, report.residual, communicator);
      result.missing      = wanted - result.forces;
      result.displacement = u;
      result.tractions =
        contact_tractions(discretization.contact(), report.residual, state);
      result.accuracy = accuracy;
      result.unit     = std::max({unit,
                                  wanted.cwiseAbs().maxCoeff(),
                                  result.forces.cwiseAbs().maxCoeff(),
                                  other_forces(discretization, report.residual)});
      // Where no force is wanted, and there is no other, nothing but rounding
      // is left of them in the end.
      largest_force = std::max(largest_force, result.unit);
      result.unit   = std::max(
        result.unit, std::min(1., rounding / tolerance) * largest_force);
      const double missing_energy =
        result.missing.cwiseProduct(compliance * result.missing)
          .cwiseAbs()
          .sum();
      result.is_found = result.error() <= tolerance * result.unit &&
        (settings.energy_tolerance == 0. ||
         result.error() <= well_known * result.unit ||
         std::sqrt(missing_energy) <= settings.energy_tolerance);

      // Where no force is wanted, and the body is free of the obstacle and of
      // loads, there are no forces but what rounding leaves of those between
      // nodes, and nothing to compare them with.
      if (!result.is_found && wanted.cwiseAbs().maxCoeff() == 0.)
        result.is_found =
          result.unit <= sum_over_processes(
                           double(discretization.constraints().n_owned_nodes()),
                           communicator) *
            std::max(rounding_of_nothing, 1e-8 * tolerance) *
            discretization.largest_stiffness() * u.linfty_norm();
      return result;
    };
    const auto solve_on = [&]() {
      SolverReport next = solve_once(accuracy);
      next.add_earlier(report);
      next.costs = phase_costs(communicator) - costs_before;
      report     = std::move(next);
    };

    // As long as much is missing, it need not be known exactly: a rough
    // solution will do, and is iterated on where it says too little. What is
    // found is found by a solution that is not rough.
    const auto set_accuracy_for = [&](const Sample &s) {
      accuracy = !may_be_rough || s.is_found || n_poor > 1
        ? 0.
        : std::min(rough, rough_share * s.error() / s.unit);
    };
    const auto reliable_sample = [&]() {
      Sample result = sample();
      while (report.converged && accuracy > 0. &&
             (result.is_found || result.error() <= accuracy * result.unit))
        {
          set_accuracy_for(result);
          solve_on();
          result = sample();
        }
      return result;
    };
    const auto solve_at = [&](const Eigen::VectorXd &s, const Sample &guess) {
      move_to(s);
      discretization.update_prescribed_values();
      u     = guess.displacement;
      state = make_initial_guess(discretization, u, guess.tractions);
      solve_on();
      ++n_positions;
      return reliable_sample();
    };

    // The derivative at a point, for which there is one solution more for each
    // position. Returns whether that need not be asked again: it has to be
    // where nothing has moved yet, or where the body is free of the obstacle
    // and its forces are rounding, but not where a solution has failed.
    const auto differentiate = [&](const Sample &at, const double step) {
      accuracy = 0.;
      const double h =
        std::max(.01 * step, 1e-4 * at.positions.cwiseAbs().maxCoeff());
      if (!(h > 0.))
        return false;
      Eigen::MatrixXd stiffness(n, n);
      bool            is_known = true;
      for (unsigned int j = 0; j < n && is_known; ++j)
        {
          Eigen::VectorXd nearby = at.positions;
          nearby[j] += h;
          stiffness.col(j) = (solve_at(nearby, at).forces - at.forces) / h;
          is_known         = report.converged;
        }
      if (!is_known)
        return true;
      constexpr double rounding = 1e-8;
      if ((compliance * stiffness).cwiseAbs().maxCoeff() <= rounding)
        return false;
      compliance = pseudo_inverse(stiffness);
      return true;
    };

    if (!report.converged)
      return report;
    Sample best = reliable_sample(), other = best;
    if (!report.converged)
      return report;
    Bracket      bracket;
    double       damping        = 1.;
    unsigned int n_retreats     = 0;
    bool         by_differences = false;
    bracket.add(best);
    while (!best.is_found)
      {
        Eigen::VectorXd step = damping * compliance * best.missing;
        if (n == 1)
          step[0] = bracket.next(best.positions[0] + step[0], n_poor > 1) -
            best.positions[0];
        if (n_retreats > 0)
          step *= std::pow(.25, n_retreats);
        const Eigen::VectorXd next = best.positions + step;
        if (n_positions >= maximum_positions ||
            next.cwiseAbs().maxCoeff() > body_size)
          give_up(best);

        // The guess: what the last change of positions has changed, as far as
        // this one goes the same way and not much farther. On a mesh for the
        // first time only the platen is moved.
        Sample                guess  = best;
        const Eigen::VectorXd change = best.positions - other.positions;
        const double          factor = step.dot(change) / change.squaredNorm();
        if (std::abs(factor) <= growth)
          for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
            guess.displacement.local_element(i) += factor *
              (best.displacement.local_element(i) -
               other.displacement.local_element(i));
        set_accuracy_for(best);
        Sample now = solve_at(next, guess);

        // Too far at once, perhaps.
        if (!report.converged)
          {
            if (++n_retreats > maximum_retreats)
              return report;
            continue;
          }
        n_retreats           = 0;
        n_poor               = now.error() < .5 * best.error() ? 0 : n_poor + 1;
        const bool is_better = now.is_found || now.error() < .9 * best.error();
        if (n_poor > 1)
          bracket.forget_rough_ends();

        // The best one may be worse than it was believed to be. Then nothing of
        // what has been tried is sure.
        if (!is_better && n_poor > 1 && best.accuracy > 0.)
          {
            accuracy = 0.;
            best     = solve_at(best.positions, best);
            if (!report.converged)
              return report;
            other = best;
            bracket.add(best);
            continue;
          }
        bracket.add(now);
        if (is_better || !by_differences)
          learn(best, now);
        if (is_better)
          {
            other          = std::move(best);
            best           = std::move(now);
            damping        = 1.;
            by_differences = false;
            continue;
          }
        other = std::move(now);

        // Several positions may go astray where friction hardly bears more:
        // then the derivative at the best point is asked for, and steps are
        // shortened until they help.
        if (by_differences)
          damping /= 2.;
        else if (n > 1 && n_poor > 2 &&
                 best.forces.cwiseAbs().maxCoeff() > 1e-9 * best.unit)
          {
            differentiate(best, step.cwiseAbs().maxCoeff());
            by_differences = true;
            n_poor         = 0;
          }
      }
    unit = best.unit;

    // What has been learnt on a way tells little of other directions. On the
    // first mesh the derivative costs next to nothing.
    if (n > 1 && !is_learnt)
      {
        const ContactState found_state  = state;
        SolverReport       found_report = report;
        is_learnt =
          differentiate(best, unit * compliance.cwiseAbs().maxCoeff());
        move_to(best.positions);
        discretization.update_prescribed_values();
        u                             = best.displacement;
        state                         = found_state;
        found_report.cycles           = report.cycles;
        found_report.outer_iterations = report.outer_iterations;
        report                        = std::move(found_report);
      }
    return report;
  }



  template <int dim>
  std::vector<double>
  ForceControl<dim>::checkpoint_numbers() const
  {
    const Eigen::VectorXd s = positions();
    std::vector<double>   numbers;
    numbers.push_back(is_learnt);
    numbers.push_back(unit);
    numbers.insert(numbers.end(), s.data(), s.data() + s.size());
    numbers.insert(numbers.end(), wanted.data(), wanted.data() + wanted.size());
    numbers.insert(
      numbers.end(), compliance.data(), compliance.data() + compliance.size());
    return numbers;
  }



  template <int dim>
  void
  ForceControl<dim>::restore(const std::vector<double> &numbers)
  {
    const unsigned int n = controls.size();
    // Forces and compliance are known when there has been a solution.
    const bool is_solved = numbers.size() > 2 + n;
    AssertThrow(numbers.size() == (is_solved ? 2 + n + n + n * n : 2 + n),
                ExcMessage("These are not the platens of this scene."));
    const double *next = numbers.data();
    is_learnt          = *next++ != 0.;
    unit               = *next++;
    move_to(Eigen::Map<const Eigen::VectorXd>(next, n));
    if (is_solved)
      {
        wanted     = Eigen::Map<const Eigen::VectorXd>(next + n, n);
        compliance = Eigen::Map<const Eigen::MatrixXd>(next + 2 * n, n, n);
      }
  }



  template <int dim>
  void
  ForceControl<dim>::predict()
  {
    if (compliance.size() > 0)
      move_to(positions() + compliance * (given_forces() - wanted));
  }



  template class ForceControl<2>;
  template class ForceControl<3>;
} // namespace Friction
