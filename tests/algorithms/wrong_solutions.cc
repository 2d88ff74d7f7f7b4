// The certificate refuses what is nearly a solution. On adaptive meshes with
// hanging nodes, in three dimensions on the contact boundary, too, a problem is
// solved, and then
// - a single value of the displacement is moved by 1e-4 of the indentation:
//   each of those of the contact boundary and some of the others,
// - the stick of each single node that bears clearly less friction than it can
//   is dropped,
// - the bounds of friction are those that the level before has found.
// All of it is beyond the default tolerance, by which the solution itself is
// accepted.

#include <common/algorithms/nested_iteration.h>

#include <algorithm>
#include <functional>
#include <iostream>

#include <tests/support/check.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_wrong_solutions
{
  // The certificate of the accepted solution with changes.
  template <int dim>
  Certificate
  certificate_of(const NestedIteration<dim>                &nest,
                 const std::function<void(VectorType &)>   &change_u,
                 const std::function<void(ContactState &)> &change_state = {})
  {
    const DiscreteProblem<dim> &problem = nest.discretization().problem();
    VectorType                  u(nest.displacement()), residual(u);
    ContactState                state = nest.state();
    change_u(u);
    if (change_state)
      change_state(state);
    problem.stiffness.residual(residual, problem.forces, u);
    return make_certificate(problem, u, residual, state);
  }



  // The indentation, of a top that is moved down.
  double
  indentation(const VectorType &u)
  {
    return u.linfty_norm();
  }



  template <int dim>
  void
  test_values(const NestedIteration<dim> &nest, const double tolerance)
  {
    const auto       &constraints = nest.discretization().constraints();
    const double      step        = 1e-4 * indentation(nest.displacement());
    double            smallest    = 1e300;
    std::vector<char> tried(constraints.n_owned_nodes(), 0);
    for (unsigned int node = 0; node < tried.size(); node += 7)
      tried[node] = 1;
    for (const auto &p : nest.discretization().contact())
      tried[p.node] = 1;
    for (unsigned int i = 0; i < dim * tried.size(); ++i)
      if (tried[i / dim] && !constraints.is_hanging(i / dim) &&
          !constraints.is_prescribed(i / dim, i % dim))
        for (const double sign : {-1., 1.})
          smallest =
            std::min(smallest, certificate_of<dim>(nest, [&](VectorType &u) {
                                 u.local_element(i) += sign * step;
                               }).largest());
    check(smallest > 10 * tolerance,
          "a value of the displacement, moved by 1e-4 of the indentation");
  }



  template <int dim>
  void
  test_flags(const NestedIteration<dim> &nest, const double tolerance)
  {
    const DiscreteProblem<dim> &problem = nest.discretization().problem();
    unsigned int                n = 0, n_caught = 0;
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      if (nest.state().in_contact(p) && nest.state().sticks(p))
        {
          ++n;
          n_caught += certificate_of<dim>(
                        nest,
                        [](VectorType &) {},
                        [&](ContactState &state) { state.set(p, true, false); })
                        .largest() > tolerance;
        }
    check(n > 0 && n_caught == n, "the stick of each node, dropped");
  }



  // To the next mesh: in three dimensions one with hanging nodes among those
  // that touch, which the estimator would not make.
  template <int dim>
  void
  go_on(NestedIteration<dim> &nest)
  {
    if (dim == 2)
      {
        nest.advance();
        return;
      }
    Random random(nest.level() + 1);
    for (const auto &cell : nest.mesh().active_cell_iterators())
      if (random(0., 1.) < .4)
        cell->set_refine_flag();
    nest.refine();
  }



  // Solves with the bounds of the guess, which are those of the level before.
  template <int dim>
  void
  test_old_bounds(NestedIteration<dim> &nest, const double tolerance)
  {
    go_on(nest);
    DiscreteProblem<dim> given   = nest.discretization().problem();
    const auto           coulomb = given;
    given.friction_law           = FrictionLaw::tresca;
    VectorType         u;
    ContactState       state = nest.make_guess(u);
    ContactSolver<dim> solver(
      nest.discretization().dof_handler(), given, nest.parameters().solver);
    const SolverReport report = solver.solve(u, state);
    check(report.converged && report.certificate.largest() < tolerance,
          "with given bounds it is a solution");
    const Certificate c = make_certificate(coulomb, u, report.residual, state);
    check(c.largest() > 100 * tolerance, "the bounds of the level before");
  }



  template <int dim>
  void
  refuse(const Parameters &parameters, const unsigned int n_levels)
  {
    NestedIteration<dim> nest(parameters);
    const double         tolerance = parameters.solver.certificate_tolerance;
    nest.begin();
    nest.solve();
    while (nest.level() < n_levels)
      {
        go_on(nest);
        nest.solve();
      }
    std::cout << dim << "D" << std::endl;
    check(nest.report().converged &&
            nest.report().certificate.largest() < .1 * tolerance,
          "the solution is accepted");
    unsigned int n_hanging = 0;
    for (unsigned int i = 0; i < nest.discretization().constraints().n_nodes();
         ++i)
      n_hanging += nest.discretization().constraints().is_hanging(i);
    check(n_hanging > 0 &&
            (dim == 2 ||
             n_hanging_at_contact<dim>(
               nest.discretization(),
               nest.scene().contact_conditions()[0].boundary_id,
               [&](const unsigned int p) {
                 return nest.state().in_contact(p);
               }) > 0),
          "there are hanging nodes where it matters");
    test_values(nest, tolerance);
    test_flags(nest, tolerance);
    test_old_bounds(nest, tolerance);
  }

} // namespace test_wrong_solutions

TEST(wrong_solutions)
{
  refuse<2>(read_parameters(SCENES_DIR "/hertz.prm"), 5);
  refuse<3>(read_parameters(SCENES_3D_DIR "/block.prm",
                            {"Refinement/Initial refinements=2"}),
            1);
}
