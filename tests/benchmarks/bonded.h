#ifndef friction_tests_benchmarks_bonded_h
#define friction_tests_benchmarks_bonded_h

#include <common/contact/contact_state.h>
#include <common/discretization/discrete_problem.h>

namespace Benchmark
{
  using namespace Friction;

  // Makes the displacements of all nodes in contact prescribed ones.
  template <int dim>
  NodalConstraints<dim>
  bond(const DiscreteProblem<dim> &problem,
       const VectorType           &u,
       const ContactState         &state)
  {
    std::vector<unsigned int> nodes;
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      if (state.in_contact(p))
        nodes.push_back(problem.contact[p].node);
    NodalConstraints<dim> bonded = problem.constraints;
    bonded.prescribe(nodes, u);
    return bonded;
  }
} // namespace Benchmark

#endif
