#include <common/algorithms/force_control.h>
#include <common/algorithms/initial_guess.h>
#include <common/contact/contact_forces.h>
#include <common/contact/force_balance.h>
#include <common/parallel/reductions.h>
#include <common/parameters/wrong_number.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Friction
{
  namespace
  {
    constexpr unsigned int maximum_solutions = 60;

    // By what factor the compliance may grow in one step, and a step with it.
    constexpr double growth = 10.;
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
  Vector<double>
  ForceControl<dim>::positions() const
  {
    Vector<double> s(controls.size());
    for (unsigned int j = 0; j < controls.size(); ++j)
      s[j] = (*scene.dirichlet_conditions()[controls[j].condition]
                 .platen->position)[controls[j].component];
    return s;
  }



  template <int dim>
  void
  ForceControl<dim>::move_to(const Vector<double> &s)
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
  Vector<double>
  ForceControl<dim>::given_forces() const
  {
    Vector<double> forces(controls.size());
    for (unsigned int j = 0; j < controls.size(); ++j)
      forces[j] = scene.dirichlet_conditions()[controls[j].condition]
                    .platen->force->value(Point<dim>(), controls[j].component);
    return forces;
  }



  template <int dim>
  std::vector<std::vector<unsigned int>>
  ForceControl<dim>::find_dofs(const Discretization<dim> &discretization) const
  {
    const std::vector<unsigned int> holders = find_holders(discretization);
    std::vector<std::vector<unsigned int>> dofs(controls.size());
    for (unsigned int i = 0; i < holders.size(); ++i)
      for (unsigned int j = 0; j < controls.size(); ++j)
        if (holders[i] == controls[j].condition &&
            i % dim == controls[j].component &&
            !discretization.constraints().is_hanging(i / dim))
          dofs[j].push_back(i);
    return dofs;
  }



  namespace
  {
    // Of the values of v at these degrees of freedom, on all processes.
    Vector<double>
    sums_over(const std::vector<std::vector<unsigned int>> &dofs,
              const VectorType                             &v,
              const MPI_Comm                                communicator)
    {
      Vector<double> sums(dofs.size());
      for (unsigned int j = 0; j < dofs.size(); ++j)
        {
          double sum = 0;
          for (const unsigned int i : dofs[j])
            sum += v.local_element(i);
          sums[j] = sum_over_processes(sum, communicator);
        }
      return sums;
    }
  } // namespace



  // The matrix with the entries e_i^T A e_j, inverted. It is positive definite:
  // no e_j is a rigid motion, or there would be nothing to press against.
  template <int dim>
  void
  ForceControl<dim>::begin_with_stiffness_of_body(
    const Discretization<dim>                    &discretization,
    const std::vector<std::vector<unsigned int>> &dofs)
  {
    FullMatrix<double> stiffness(controls.size());
    VectorType         e = discretization.vector(), Ae = e;
    for (unsigned int j = 0; j < controls.size(); ++j)
      {
        e = 0.;
        for (const unsigned int i : dofs[j])
          e.local_element(i) = 1.;
        discretization.stiffness().vmult(Ae, e);
        const Vector<double> column =
          sums_over(dofs, Ae, discretization.constraints().communicator());
        for (unsigned int i = 0; i < controls.size(); ++i)
          stiffness(i, j) = column[i];
      }
    compliance.reinit(controls.size(), controls.size());
    compliance.invert(stiffness);
  }



  // Broyden's update, that of the inverse by the formula of Sherman and
  // Morrison. It is damped, in the way of Powell, where the compliance along
  // the last step would change its sign or grow by more than a factor.
  template <int dim>
  void
  ForceControl<dim>::learn(const Sample &before, const Sample &now)
  {
    Vector<double> step = now.positions, change = now.forces;
    step -= before.positions;
    change -= before.forces;
    const double length = step.norm_sqr();
    if (length == 0.)
      return;
    Vector<double> predicted(controls.size()), row(controls.size());
    compliance.vmult(predicted, change);
    const double ratio = (step * predicted) / length;
    if (ratio < 1. / growth)
      {
        const double damping = (1. - 1. / growth) / (1. - ratio);
        predicted *= damping;
        predicted.add(1. - damping, step);
      }
    const double divisor = step * predicted;
    compliance.Tvmult(row, step);
    step -= predicted;
    for (unsigned int i = 0; i < controls.size(); ++i)
      for (unsigned int j = 0; j < controls.size(); ++j)
        compliance(i, j) += step[i] * row[j] / divisor;
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
      scene.subject() +
      "the forces of 'Boundary conditions/Force' cannot be reached; nearest to "
      "them " +
      text.str() +
      ". Can contact and friction bear them, and does 'Displacement' begin in "
      "contact?");
  }



  template <int dim>
  SolverReport
  ForceControl<dim>::solve(Discretization<dim>                 &discretization,
                           VectorType                          &u,
                           ContactState                        &state,
                           const double                         tolerance,
                           const std::function<SolverReport()> &solve_once)
  {
    if (!has_platens())
      return solve_once();

    const MPI_Comm   communicator = discretization.constraints().communicator();
    const PhaseCosts costs_before = phase_costs(communicator);
    SolverReport     report       = solve_once();
    unsigned int     n_solutions  = 1;
    const auto       dofs         = find_dofs(discretization);
    if (compliance.empty())
      begin_with_stiffness_of_body(discretization, dofs);
    wanted = given_forces();

    // The residual is what is left of the loads; the force of what holds the
    // body is opposite to it.
    const auto sample = [&]() {
      Sample now = {
        positions(),
        sums_over(dofs, report.residual, communicator),
        wanted,
        u,
        contact_tractions(discretization.contact(), report.residual, state)};
      now.forces *= -1.;
      now.missing -= now.forces;
      return now;
    };
    const auto solve_at = [&](const Vector<double> &s, const Sample &guess) {
      move_to(s);
      discretization.update_prescribed_values();
      u     = guess.displacement;
      state = make_initial_guess(discretization, u, guess.tractions);
      SolverReport next = solve_once();
      next.add_earlier(report);
      next.costs = phase_costs(communicator) - costs_before;
      report     = std::move(next);
      ++n_solutions;
      return sample();
    };

    Sample       best           = sample(), other;
    double       damping        = 1.;
    unsigned int n_rejected     = 0;
    bool         by_differences = false;
    while (report.converged &&
           best.missing.linfty_norm() > tolerance *
               std::max(wanted.linfty_norm(), best.forces.linfty_norm()))
      {
        Vector<double> step(controls.size());
        compliance.vmult(step, best.missing);
        step *= damping;
        Vector<double> next = best.positions;
        next += step;
        if (n_solutions >= maximum_solutions ||
            next.linfty_norm() > discretization.body_size())
          give_up(best);

        // The guess: what the last change of a single position has changed,
        // once more. On a mesh for the first time only the platen is moved.
        Sample guess = best;
        if (n_solutions > 1 && controls.size() == 1)
          {
            const double factor =
              step[0] / (best.positions[0] - other.positions[0]);
            for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
              guess.displacement.local_element(i) += factor *
                (best.displacement.local_element(i) -
                 other.displacement.local_element(i));
          }
        Sample     now = solve_at(next, guess);
        const bool is_better =
          now.missing.linfty_norm() < .9 * best.missing.linfty_norm();
        if (is_better || !by_differences)
          learn(best, now);
        if (is_better)
          {
            other          = std::move(best);
            best           = std::move(now);
            damping        = 1.;
            n_rejected     = 0;
            by_differences = false;
            continue;
          }

        // One position alone is enclosed by what has been tried. Several may go
        // astray where friction hardly bears more: then the derivative at the
        // best point is asked for, and steps are shortened until they help.
        other = std::move(now);
        if (by_differences)
          damping /= 2.;
        else if (controls.size() > 1 && ++n_rejected > 2 &&
                 best.forces.linfty_norm() > 1e-9 * wanted.linfty_norm())
          {
            const double    h = .01 * step.linfty_norm();
            Eigen::MatrixXd stiffness(controls.size(), controls.size());
            for (unsigned int j = 0; j < controls.size() && report.converged;
                 ++j)
              {
                Vector<double> nearby = best.positions;
                nearby[j] += h;
                const Sample there = solve_at(nearby, best);
                for (unsigned int i = 0; i < controls.size(); ++i)
                  stiffness(i, j) = (there.forces[i] - best.forces[i]) / h;
              }
            const Eigen::MatrixXd inverse =
              stiffness.completeOrthogonalDecomposition().pseudoInverse();
            for (unsigned int i = 0; i < controls.size(); ++i)
              for (unsigned int j = 0; j < controls.size(); ++j)
                compliance(i, j) = inverse(i, j);
            by_differences = true;
          }
      }
    return report;
  }



  template <int dim>
  void
  ForceControl<dim>::adopt(Discretization<dim> &discretization,
                           const VectorType    &u)
  {
    if (!has_platens())
      return;
    const auto     dofs         = find_dofs(discretization);
    const MPI_Comm communicator = discretization.constraints().communicator();
    const VectorType &values = discretization.constraints().prescribed_values();
    const Vector<double> there = sums_over(dofs, u, communicator),
                         here  = sums_over(dofs, values, communicator);
    Vector<double> s           = positions();
    for (unsigned int j = 0; j < controls.size(); ++j)
      s[j] += (there[j] - here[j]) /
        sum_over_processes(double(dofs[j].size()), communicator);
    move_to(s);
    discretization.update_prescribed_values();
  }



  template <int dim>
  void
  ForceControl<dim>::predict()
  {
    if (!has_platens() || compliance.empty())
      return;
    Vector<double> change = given_forces(), step(controls.size());
    change -= wanted;
    compliance.vmult(step, change);
    step += positions();
    move_to(step);
  }



  template class ForceControl<2>;
  template class ForceControl<3>;
} // namespace Friction
