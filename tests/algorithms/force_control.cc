// Boundaries whose total force is given, and not their displacement. Of a block
// whose stress is the same everywhere, both are known: with the force given,
// its top has to be found where it is moved to in the scene stick-slip, exact
// to the tolerance of the solver, on any mesh, hanging nodes included. So it is
// with one and with all components given, in a turned scene, from where nothing
// touches, and in a history. Where nothing is known in closed form, the force
// of a displacement must have this displacement, after few cycles on each mesh.

#include <common/algorithms/contact_solver.h>
#include <common/algorithms/initial_guess.h>
#include <common/algorithms/nested_iteration.h>
#include <common/contact/force_balance.h>

#include <iostream>
#include <string>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_force_control
{
  std::string
  scene_file(const unsigned int dim, const std::string &name)
  {
    return (dim == 2 ? SCENES_DIR "/" : SCENES_3D_DIR "/") + name;
  }



  // The largest difference from the solution that the scene knows.
  template <int dim>
  double
  error(const NestedIteration<dim> &nest)
  {
    const auto     points = node_points(nest.discretization());
    Vector<double> exact(dim);
    double         largest = 0;
    for (unsigned int i = 0;
         i < nest.discretization().constraints().n_owned_nodes();
         ++i)
      {
        nest.scene().exact_displacement()->vector_value(points[i], exact);
        for (unsigned int c = 0; c < dim; ++c)
          largest =
            std::max(largest,
                     std::abs(exact[c] -
                              nest.displacement().local_element(dim * i + c)));
      }
    return Utilities::MPI::max(largest, MPI_COMM_WORLD);
  }



  // Of one part of the boundary.
  template <int dim>
  ForceOnBody<dim>
  held(const NestedIteration<dim> &nest, const std::string &name)
  {
    const ForceBalance<dim> balance =
      force_balance(nest.discretization(), nest.report().residual);
    for (const ForceOnBody<dim> &force : balance.forces)
      if (force.name == name)
        return force;
    AssertThrow(false, ExcInternalError());
    return ForceOnBody<dim>();
  }



  // Some cells are refined; in space nodes of the top hang then.
  template <int dim>
  void
  refine_some(NestedIteration<dim> &nest)
  {
    for (const auto &cell : nest.mesh().active_cell_iterators())
      if (cell->is_locally_owned() && cell->center()[0] > .5)
        cell->set_refine_flag();
    nest.refine();
  }



  template <int dim>
  void
  patch_test(const std::string &what, const std::vector<std::string> &entries)
  {
    std::vector<std::string> all = {"Refinement/Initial refinements=0",
                                    "Solver/Inner tolerance=1e-12",
                                    "Solver/Certificate tolerance=1e-9"};
    all.insert(all.end(), entries.begin(), entries.end());
    NestedIteration<dim> nest(without_safeguards(
      read_parameters(scene_file(dim, "stick-slip.prm"), all)));
    nest.begin();
    double worst = 0;
    bool   good  = nest.solve().converged;
    worst        = error(nest);
    refine_some(nest);
    good  = nest.solve().converged && good;
    worst = std::max(worst, error(nest));
    while (nest.begin_next_load_step())
      {
        good  = nest.solve().converged && good;
        worst = std::max(worst, error(nest));
      }
    good = good &&
      nest.scene().dirichlet_conditions()[0].platen->position->norm() > 1e-3;
    check_everywhere(good && worst < 1e-9, what);
    if (!(worst < 1e-9) &&
        Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << "    error " << worst << std::endl;
  }



  // The displacement of a run is found again from its force.
  template <int dim>
  void
  find_again(const std::string &scene,
             const std::string &boundary,
             const std::string &start,
             const std::string &levels)
  {
    const std::string strategy = "Refinement/Strategy=uniform",
                      accuracy = "Solver/Inner tolerance=1e-9";
    NestedIteration<dim> given(without_safeguards(
      read_parameters(scene_file(dim, scene), {strategy, levels, accuracy})));
    given.begin();
    do
      given.solve();
    while (given.advance());
    const Tensor<1, dim> force = held(given, "held_" + boundary).total;
    std::ostringstream   text;
    text.precision(16);
    text << "Boundary conditions/Force=" << boundary << ": ";
    for (unsigned int d = 0; d + 1 < dim; ++d)
      text << "free, ";
    text << force[dim - 1];

    NestedIteration<dim> found(without_safeguards(read_parameters(
      scene_file(dim, scene),
      {strategy,
       levels,
       accuracy,
       text.str(),
       "Boundary conditions/Displacement=" + boundary + ": " + start})));
    found.begin();
    bool good = true;
    do
      good = found.solve().converged && good;
    while (found.advance());
    double largest = 0;
    for (unsigned int i = 0; i < found.displacement().locally_owned_size(); ++i)
      largest = std::max(largest,
                         std::abs(found.displacement().local_element(i) -
                                  given.displacement().local_element(i)));
    largest = Utilities::MPI::max(largest, MPI_COMM_WORLD) /
      given.displacement().linfty_norm();
    check_everywhere(good && largest < 1e-5,
                     scene + ": the force of a displacement has it");
    check_everywhere(found.report().outer_iterations > 1 &&
                       found.report().cycles.size() <=
                         2 * given.report().cycles.size(),
                     scene + ": at most twice as many cycles on the last mesh");
  }



  // The force is taken back altogether.
  void
  unload()
  {
    NestedIteration<2> nest(without_safeguards(
      read_parameters(SCENES_DIR "/stick-slip.prm",
                      {"Load steps/Times=0, 1",
                       "Scene/Constants=L = 2; H = 1; U = 0; d = 0.02; gap = 0",
                       "Refinement/Levels=0",
                       "Boundary conditions/Displacement=3: U, -d",
                       "Boundary conditions/Force=3: free, -p*L*(1 - t)",
                       "Boundary conditions/Traction=0: -side*(1 - t), 0; "
                       "1: side*(1 - t), 0"})));
    nest.begin();
    bool         good  = nest.solve().converged;
    const double force = held(nest, "held_3").total.norm();
    good               = nest.begin_next_load_step() && good;
    good               = nest.solve().converged && good;
    check_everywhere(good && force > .01 &&
                       held(nest, "held_3").total.norm() < 1e-6 * force,
                     "in the end there is no force");
  }



  // Nor is there any force to begin with, on two meshes.
  void
  load(const std::string &name, const std::vector<std::string> &entries)
  {
    std::vector<std::string> overrides = {"Load steps/Times=0, 1"};
    overrides.insert(overrides.end(), entries.begin(), entries.end());
    NestedIteration<2> nest(without_safeguards(
      read_parameters(SCENES_DIR "/stick-slip.prm", overrides)));
    nest.begin();
    bool good = nest.solve().converged;
    refine_some(nest);
    good               = nest.solve().converged && good;
    const double force = held(nest, "held_3").total.norm();
    good               = nest.begin_next_load_step() && good;
    good               = nest.solve().converged && good;
    check_everywhere(good && force < 1e-12 && error(nest) < 1e-6,
                     "in the beginning there is no force" + name);
  }



  // From wherever it begins, and however exact it has to be: what is returned
  // is not a rough solution, and has the force, up to the tolerance and to the
  // energy of the displacement that is missing.
  void
  last_one()
  {
    const double     force      = -.003;
    const Parameters parameters = without_safeguards(
      read_parameters(scene_file(2, "hertz.prm"),
                      {"Boundary conditions/Force=1: free, -0.003",
                       "Boundary conditions/Displacement=1: 0, -0.001"}));
    Scene<2>   scene(parameters);
    const auto mesh = make_triangulation<2>();
    scene.make_coarse_mesh(*mesh);
    mesh->refine_global(2);
    Discretized<2>   discretization(scene, *mesh);
    ForceControl<2>  control(scene);
    ContactSolver<2> solver(discretization, parameters.solver);
    VectorType       u         = discretization.vector();
    const VectorType tractions = u;
    double           last = 0, most_missing = 0, most_energy = 0;
    bool             converged = true, is_rough = false, was_rough = false;
    const auto       solve = [&](const SolverSettings &settings) {
      ContactState state = make_initial_guess(discretization, u, tractions);
      const SolverReport report = control.solve(
        discretization, u, state, settings, [&](const double accuracy) {
          last      = accuracy;
          was_rough = was_rough || accuracy > 0;
          return solver.solve(u, state, {}, accuracy);
        });
      converged    = converged && report.converged;
      is_rough     = is_rough || last > 0;
      double total = 0;
      for (const ForceOnBody<2> &part :
           force_balance(discretization, report.residual).forces)
        if (part.name == "held_1")
          total = part.total[1];
      const double missing    = std::abs(force - total);
      const double compliance = control.checkpoint_numbers().back();
      most_missing            = std::max(
        most_missing, missing / settings.certificate_tolerance / -force);
      // The force is met to 1e-6 in any case, in the unit of below.
      if (settings.energy_tolerance > 0 && missing > -1.1e-6 * force)
        most_energy = std::max(most_energy,
                               std::sqrt(std::abs(compliance)) * missing /
                                 settings.energy_tolerance);
    };
    SolverSettings settings = parameters.solver;
    solve(settings);
    for (const double tolerance : {1e-2, 1e-4, 1e-6})
      for (const double energy : {0., 1e-4, 1e-6, 1e-12})
        for (const double share : {0., .9, .9999, 1.5})
          {
            settings.certificate_tolerance = tolerance;
            settings.energy_tolerance      = energy;
            std::vector<double> numbers    = control.checkpoint_numbers();
            numbers[2] *= share;
            control.restore(numbers);
            discretization.update_prescribed_values();
            solve(settings);
          }
    check_everywhere(converged && was_rough && !is_rough,
                     "what is returned is not a rough solution");
    // The unit is the sum of all nodal forces, which are not quite parallel.
    check_everywhere(most_missing <= 1.1, "it has the force");
    check_everywhere(most_energy < 2.,
                     "and little energy is missing if this has been asked for");
  }



  // A run that was interrupted goes on with what it had learnt, with its
  // platens and with its slip: the third load step is solved by as many cycles.
  void
  resume()
  {
    const std::vector<std::string> entries = {
      "Load steps/Times=0, 1, 2, 3",
      "Scene/Constants=L = 2; H = 1; gap = 0",
      "Scene/Definitions=d = 0.02 + 0.002*t; p = (lambda + 2*mu)*d/H; side = "
      "-lambda*d/H; U = 0.01*t; slip = 0; q = mu*U/H",
      "Boundary conditions/Displacement=3: 0, -0.02",
      "Boundary conditions/Force=3: q*L, -p*L"};
    const Parameters parameters = without_safeguards(
      read_parameters(SCENES_DIR "/stick-slip.prm", entries));
    NestedIteration<2> nest(parameters), next(parameters);
    bool               good = true;
    nest.begin();
    for (unsigned int step = 0; step < 2; ++step)
      {
        good = nest.solve().converged && good;
        good = nest.begin_next_load_step() && good;
      }

    next.scene().make_coarse_mesh(next.mesh());
    next.begin_on_level(2, 2, nest.platens().checkpoint_numbers());
    const std::vector<VectorType *> from = nest.checkpoint_vectors(),
                                    to   = next.checkpoint_vectors();
    for (unsigned int i = 0; i < from.size(); ++i)
      to[i]->copy_locally_owned_data_from(*from[i]);
    next.resume();
    check_everywhere(from.size() == 5 && to.size() == 5, "five vectors");
    for (unsigned int step = 3; step < 5; ++step)
      {
        good = nest.solve().converged && next.solve().converged && good;
        VectorType difference = nest.displacement();
        difference -= next.displacement();
        check_everywhere(
          good && nest.report().cycles.size() == next.report().cycles.size() &&
            difference.linfty_norm() <
              1e-12 * nest.displacement().linfty_norm(),
          "step " + std::to_string(step) + " of a run that is continued");
        good = nest.begin_next_load_step() == next.begin_next_load_step();
      }
    check_everywhere(nest.platens().checkpoint_numbers() ==
                       next.platens().checkpoint_numbers(),
                     "and has learnt the same");
  }
} // namespace test_force_control

TEST(force_control)
{
  const std::string sticks =
    "Scene/Constants=L = 2; H = 1; U = 0.01; d = 0.02; gap = 0";
  const std::string both = "Boundary conditions/Force=3: q*L, -p*L";
  patch_test<2>("pressed by a force, all sticks",
                {sticks,
                 "Boundary conditions/Displacement=3: U, -0.5*d",
                 "Boundary conditions/Force=3: free, -p*L"});
  patch_test<2>(
    "pressed and dragged by forces, all sticks",
    {sticks, "Boundary conditions/Displacement=3: 0, -0.5*d", both});
  patch_test<2>("in a turned scene",
                {sticks,
                 "Scene/Rotation angle=30",
                 "Boundary conditions/Displacement=3: 0, -0.5*d",
                 both});
  patch_test<2>("pressed by a force, all slips",
                {"Boundary conditions/Displacement=3: U, -1.5*d",
                 "Boundary conditions/Force=3: free, -p*L"});
  patch_test<2>("nothing touches to begin with",
                {"Scene/Constants=L = 2; H = 1; U = 0.01; d = 0.02; gap = 0.01",
                 "Boundary conditions/Displacement=3: U, 0",
                 "Boundary conditions/Force=3: free, -p*L"});
  patch_test<2>("far from anything to begin with",
                {"Scene/Constants=L = 2; H = 1; U = 0; d = 0.003; gap = 0.3",
                 "Boundary conditions/Displacement=3: U, 0",
                 "Boundary conditions/Force=3: free, -p*L"});
  patch_test<2>("much too deep to begin with",
                {"Scene/Constants=L = 2; H = 1; U = 0; d = 0.003; gap = 0",
                 "Boundary conditions/Displacement=3: U, -0.3",
                 "Boundary conditions/Force=3: free, -p*L"});
  patch_test<2>("with Algorithm 2",
                {"Scene/Constants=L = 2; H = 1; U = 0.04; d = 0.02; gap = 0",
                 "Solver/Algorithm=fixed point",
                 "Solver/Outer tolerance=1e-11",
                 "Boundary conditions/Displacement=3: U, -1.5*d",
                 "Boundary conditions/Force=3: free, -p*L"});
  patch_test<2>("without a force sideways",
                {"Scene/Constants=L = 2; H = 1; U = 0; d = 0.02; gap = 0",
                 "Boundary conditions/Displacement=3: 0.005, -d",
                 "Boundary conditions/Force=3: 0, free"});
  patch_test<2>("two platens",
                {"Scene/Constants=L = 2; H = 1; U = 0; d = 0.02; gap = 0",
                 "Boundary conditions/Displacement=3: free, -0.5*d; "
                 "0: 0.002, free",
                 "Boundary conditions/Traction=1: side, q",
                 "Boundary conditions/Force=3: free, -p*L; 0: -side*H, free"});
  patch_test<2>(
    "in a history of pressing and dragging",
    {"Load steps/Times=0, 1, 2, 3, 4",
     "Scene/Constants=L = 2; H = 1; gap = 0",
     "Scene/Definitions=d = 0.02 + 0.01*min(t, 1); p = (lambda + 2*mu)*d/H; "
     "side = -lambda*d/H; U = if(t < 0.5, 0, if(t < 1.5, 0.01, if(t < 2.5, "
     "0.015, 0.005))); slip = 0; q = mu*U/H",
     "Boundary conditions/Displacement=3: 0, -0.02",
     both});
  patch_test<3>(
    "in space, three components",
    {"Scene/Constants=L = 1.5; W = 1; H = 1; U = 0.01; alpha = pi/6; d = 0.02; "
     "gap = 0",
     "Boundary conditions/Displacement=5: 0, 0, -0.5*d",
     "Boundary conditions/Force=5: qx*L*W, qy*L*W, -p*L*W"});
  unload();
  load("",
       {"Scene/Constants=L = 2; H = 1; U = 0; d = 0.02; gap = 0",
        "Boundary conditions/Displacement=3: U, 0",
        "Boundary conditions/Force=3: free, -p*L*t",
        "Boundary conditions/Traction=0: -side*t, 0; 1: side*t, 0"});
  load(", in two components",
       {"Scene/Constants=L = 2; H = 1; U = 0.01; d = 0.02; gap = 0",
        "Boundary conditions/Displacement=3: 0, 0",
        "Boundary conditions/Force=3: q*L*t, -p*L*t",
        "Boundary conditions/Traction=0: -side*t, -q*t; 1: side*t, q*t"});
  last_one();
  resume();
  find_again<2>("hertz.prm", "1", "0, -0.001", "Refinement/Levels=3");
  find_again<3>("half-ball.prm", "1", "0, 0, -0.02", "Refinement/Levels=2");
}
