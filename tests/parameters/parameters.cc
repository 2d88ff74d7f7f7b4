// Scene files, overrides, and what is said about everything wrong in them.

#include <common/parameters/parameters.h>
#include <common/parameters/scene_file.h>

#include <fstream>
#include <iostream>
#include <sstream>

#include <tests/support/test.h>

using namespace Friction;

namespace test_parameters
{
  // Read a file with the given text; the sentence if that fails.
  void
  check(const std::string              &what,
        const std::string              &text,
        const std::vector<std::string> &overrides = {})
  {
    {
      std::ofstream file("scene.prm");
      file << text;
    }
    std::cout << what << "\n  ";
    try
      {
        read_parameters("scene.prm", overrides);
        std::cout << "accepted\n";
      }
    catch (const InputError &error)
      {
        std::cout << error.what() << "\n";
      }
  }
} // namespace test_parameters

TEST(parameters)
{
  const std::string good = "# a comment\n"
                           "subsection Scene\n"
                           "  set Constants = L = 2; M = L^2\n"
                           "  set Size = L, \\\n"
                           "             M/2 # goes on\n"
                           "  set Definitions = r = x/L; s = r + 1e-1*r\n"
                           "end\n"
                           "subsection Contact\n"
                           "  set Friction coefficient = 0.4\n"
                           "end\n";
  {
    std::ofstream("some.scene.prm") << good;
    const Parameters p = read_parameters("some.scene.prm",
                                         {"Contact/Friction coefficient=1.5",
                                          "Material/Poisson ratio = 0.25",
                                          "Solver/Algorithm=fixed point",
                                          "Solver/Truncation=contact",
                                          "Solver/Local solver=Uzawa",
                                          "Output/Fields=false"});
    std::cout << p.name << "\nsize " << p.scene.size[0] << ' '
              << p.scene.size[1] << "\nF " << p.contact.friction_coefficient
              << "\nnu " << p.material.poisson_ratio() << "\nlambda, mu "
              << p.material.lambda() << ' ' << p.material.mu()
              << "\nfixed point "
              << (p.solver.algorithm == Algorithm::fixed_point) << "\ncontact "
              << (p.solver.truncation == TruncationVariant::contact)
              << "\nUzawa " << (p.solver.local_solver == LocalSolver::uzawa)
              << "\nfields " << p.output.fields << "\nexpanded "
              << p.expressions.expand("2*s*max(r,x)") << "\nmu + F "
              << p.expressions.evaluate("mu + F", "here") << std::endl;

    // The text kept with the results is a scene file for the same parameters.
    std::ofstream("again.prm") << p.text;
    std::cout << "same text again "
              << (read_parameters("again.prm").text == p.text) << std::endl;

    // The documented defaults are a scene file as well, and the solver's are
    // those of its settings.
    std::ostringstream defaults;
    print_default_parameters(defaults);
    std::ofstream("defaults.prm") << defaults.str();
    const SolverSettings solver = read_parameters("defaults.prm").solver;
    const SolverSettings settings;
    std::cout << "same solver "
              << (solver.algorithm == settings.algorithm &&
                  solver.coarse_correction == settings.coarse_correction &&
                  solver.cycle == settings.cycle &&
                  solver.coarsest_method == settings.coarsest_method &&
                  solver.truncation == settings.truncation &&
                  solver.local_solver == settings.local_solver &&
                  solver.smoothing_steps == settings.smoothing_steps &&
                  solver.coarse_smoothing_steps ==
                    settings.coarse_smoothing_steps &&
                  solver.inner_tolerance == settings.inner_tolerance &&
                  solver.outer_tolerance == settings.outer_tolerance &&
                  solver.certificate_tolerance ==
                    settings.certificate_tolerance &&
                  solver.maximum_cycles == settings.maximum_cycles &&
                  solver.maximum_outer_iterations ==
                    settings.maximum_outer_iterations &&
                  solver.maximum_step_length == settings.maximum_step_length &&
                  solver.recombined_steps == settings.recombined_steps &&
                  solver.outer_damping == settings.outer_damping)
              << std::endl;
  }

  // A coefficient of friction that varies is a definition, wherever it stands.
  {
    const Parameters p =
      read_parameters("some.scene.prm",
                      {"Contact/Friction coefficient=0.1*r",
                       "Scene/Definitions=r = x/L; s = F + r"});
    std::cout << "F " << p.contact.varying_coefficient << ", expanded "
              << p.expressions.expand("F") << ", in a definition "
              << p.expressions.expand("s") << std::endl;
  }

  // The sweeps that no entry asks for.
  for (const std::string nu :
       {"0", "0.3", "0.45", "0.475", "0.476", "0.49", "0.495", "0.4999"})
    {
      const std::string    ratio = "Material/Poisson ratio=" + nu;
      const SolverSettings pointwise =
        read_parameters("some.scene.prm", {ratio}).solver;
      const SolverSettings mean =
        read_parameters("some.scene.prm",
                        {ratio, "Material/Volumetric strain=mean"})
          .solver;
      const SolverSettings given =
        read_parameters("some.scene.prm",
                        {ratio,
                         "Solver/Smoothing steps=2",
                         "Solver/Coarse smoothing steps=1"})
          .solver;
      std::cout << "sweeps for nu = " << nu << ": " << pointwise.smoothing_steps
                << ", " << pointwise.coarse_smoothing_steps << "; mean strains "
                << mean.smoothing_steps << ", " << mean.coarse_smoothing_steps
                << "; given " << given.smoothing_steps << ", "
                << given.coarse_smoothing_steps
                << (pointwise.nearly_incompressible() ? ", hardly compressible"
                                                      : "")
                << std::endl;
    }

  std::cout << "Eck's bounds " << eck_bound(2, .3) << ' ' << eck_bound(3, .3)
            << "\n\n";

  std::cout << "no file\n  ";
  try
    {
      read_parameters("nowhere.prm");
    }
  catch (const InputError &error)
    {
      std::cout << error.what() << "\n";
    }

  check("good", good);
  check("unknown entry", "subsection Contact\n  set Frction law = none\nend\n");
  check("unknown section", "subsection Contakt\nend\n");
  check("no section", "set Friction law = none\n");
  check("section in section", "subsection Scene\nsubsection Contact\n");
  check("section not closed", "\nsubsection Scene\n");
  check("too many ends", "subsection Scene\nend\nend\n");
  check("no such statement", "subsection Scene\n  Size = 1, 1\nend\n");
  check("no choice", "subsection Solver\n  set Cycle = F\nend\n");
  check("no number", "subsection Material\n  set Poisson ratio = 1/3\nend\n");
  check("entry twice",
        "subsection Solver\n  set Cycle = V\nend\n"
        "subsection Solver\n  set Cycle = W\nend\n");
  check("override twice", good, {"Solver/Cycle=V", "Solver/Cycle=W"});
  check("unknown override", good, {"Solver/Cycles=V"});
  check("override without value", good, {"Solver/Cycle"});
  check("override without section", good, {"Cycle=V"});
  check("override without match", good, {"Solver/Smoothing steps=0"});
  check("negative tolerance", good, {"Solver/Inner tolerance=-1"});
  check(
    "stop without Algorithm 3",
    good,
    {"Solver/Inner tolerance=discretisation", "Solver/Algorithm=fixed point"});
  check("stop without estimate",
        good,
        {"Solver/Inner tolerance=discretisation",
         "Refinement/Estimate error=false"});
  check("levels", good, {"Refinement/Levels=1000"});
  check("E = 0", "\nsubsection Material\n  set Young's modulus = 0\nend\n");
  check("nu = 0.5", good, {"Material/Poisson ratio=0.5"});
  check("nu = -1", good, {"Material/Poisson ratio=-1"});
  check("F < 0", good, {"Contact/Friction coefficient=-0.1"});
  check("F", good, {"Contact/Friction coefficient=0.1*q"});
  check("F of itself", good, {"Contact/Friction coefficient=2*F"});
  check("F twice",
        good,
        {"Contact/Friction coefficient=r", "Scene/Definitions=r = x; F = y"});
  check("size", good, {"Scene/Size=1, -1"});
  check("size", good, {"Scene/Size=1, 1/0"});
  check("size", good, {"Scene/Size=1, q"});
  check("radius", good, {"Scene/Radius=0"});
  check("length", good, {"Scene/Length=0"});
  check("coarse grid", good, {"Scene/Coarse grid=two cells"});
  check("layers", good, {"Scene/Layers=-1"});
  check("length of rods", good, {"Obstacle/Length=0"});
  check("length of rods", good, {"Obstacle/Length=q"});
  check("subdivisions", good, {"Scene/Subdivisions=1, 1.5"});
  check("distortion", good, {"Scene/Distortion=0.9"});
  check("no mesh file", good, {"Scene/Geometry=mesh file"});
  check("constant", good, {"Scene/Constants=1"});
  check("constant", good, {"Scene/Constants=x=1"});
  check("constant", good, {"Scene/Constants=F=1"});
  check("no rods", good, {"Obstacle/Kind=rods"});
  check("no normal", good, {"Obstacle/Normal=0, 0"});
  check("conditions", good, {"Boundary conditions/Displacement=0, 0"});
  check("directory", good, {"Output/Directory="});
  check("units", good, {"Output/Units=length: mm, force: N"});
  check("one unit", good, {"Output/Units=force: kN"});
  check("units", good, {"Output/Units=mm, N"});
  check("units", good, {"Output/Units=length: mm, time: s"});
  check("units", good, {"Output/Units=length: mm, length: m"});
  check("units", good, {"Output/Units=length: \"mm\""});
  check("units", good, {"Output/Units=length:"});
}
