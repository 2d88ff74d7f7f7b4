#include <tests/benchmarks/baselines/newton_direct.h>

#include <algorithm>
#include <cmath>
#include <deque>

namespace Benchmark
{
  template <int dim>
  NewtonDirect<dim>::NewtonDirect(const DiscreteProblem<dim> &problem,
                                  const VectorType           &u,
                                  const ContactState         &state)
    : rotated(problem)
    , F(problem.effective_coefficient())
    , chosen(problem.contact.size(), 0)
  {
    AssertThrow(!problem.has_friction() ||
                  problem.friction_law == FrictionLaw::coulomb,
                ExcMessage("Newton's method knows Coulomb's law only."));
    unsigned int nearest = 0;
    double       room    = 1e300;
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      {
        chosen[p] = state.in_contact(p);
        const double room_here =
          problem.contact[p].gap - normal_component(problem.contact[p], u);
        if (room_here < room)
          {
            nearest = p;
            room    = room_here;
          }
      }
    if (problem.contact.size() > 0)
      chosen[nearest] = 1;
    choose_neighbors(n_layers);
    stiffness = contact_stiffness(rotated, chosen);
    make_factor();
  }



  template <int dim>
  void
  NewtonDirect<dim>::make_factor()
  {
    std::vector<unsigned int> last;
    for (unsigned int p = 0; p < chosen.size(); ++p)
      if (chosen[p])
        last.push_back(p);
    factor.reset();
    factor = std::make_unique<StiffnessFactor<dim>>(rotated, last);
  }



  template <int dim>
  void
  NewtonDirect<dim>::choose_neighbors(const unsigned int n_layers)
  {
    const DiscreteProblem<dim> &problem = rotated.problem;
    const auto                 &A       = problem.stiffness.blocks();
    for (unsigned int layer = 0; layer < n_layers; ++layer)
      {
        std::vector<char> more = chosen;
        for (unsigned int p = 0; p < chosen.size(); ++p)
          if (chosen[p])
            {
              const unsigned int node = problem.contact[p].node;
              for (auto e = A.row_begin(node); e < A.row_end(node); ++e)
                {
                  const unsigned int q = rotated.contact_number(A.column(e));
                  if (q != numbers::invalid_unsigned_int)
                    more[q] = 1;
                }
            }
        chosen = more;
      }
  }



  // Values at a node of the dense block. What is prescribed there, and is no
  // part of the block, is filled in.
  template <int dim>
  NodeValue<dim>
  NewtonDirect<dim>::at_node(const std::vector<double> &values,
                             const unsigned int         i) const
  {
    const ContactNode<dim> &node = rotated.problem.contact[factor->nodes()[i]];
    NodeValue<dim>          result{};
    for (unsigned int e = 0; e <= node.n_free_tangents; ++e)
      result[e] = values[factor->position(i, e)];
    return result;
  }



  template <int dim>
  void
  NewtonDirect<dim>::evaluate(Iterate                   &iterate,
                              const std::vector<double> *given_bounds) const
  {
    const DenseMatrix &S = factor->schur_complement();
    iterate.r            = b;
    for (std::size_t j = 0; j < S.n; ++j)
      for (std::size_t i = 0; i < S.n; ++i)
        iterate.r[i] -= S(i, j) * iterate.x[j];
    iterate.laws.resize(factor->nodes().size());
    iterate.violation     = 0;
    iterate.largest_force = 0;
    for (unsigned int i = 0; i < factor->nodes().size(); ++i)
      {
        const ContactNode<dim> &node =
          rotated.problem.contact[factor->nodes()[i]];
        const NodeValue<dim> r          = at_node(iterate.r, i);
        NodeValue<dim>       x          = at_node(iterate.x, i);
        const auto           prescribed = tangential_components<dim>(
          node, rotated.problem.constraints.prescribed_values());
        for (unsigned int e = node.n_free_tangents + 1; e < dim; ++e)
          x[e] = prescribed[e - 1];
        iterate.laws[i] =
          linearize<dim>(node,
                         F * node.friction_share,
                         stiffness[factor->nodes()[i]],
                         x.data(),
                         r.data(),
                         given_bounds == nullptr ? -1. : (*given_bounds)[i]);
        iterate.violation += std::pow(iterate.laws[i].violation, 2);
        for (const double force : r)
          iterate.largest_force =
            std::max(iterate.largest_force, std::abs(force));
      }
    iterate.violation = std::sqrt(iterate.violation);
  }



  // Normal components in contact, and sticking ones, are known; the linear
  // system is that of the others.
  template <int dim>
  std::vector<double>
  NewtonDirect<dim>::newton_step(const Iterate &iterate) const
  {
    const DenseMatrix        &S = factor->schur_complement();
    std::vector<double>       v(S.n, 0.), rhs;
    std::vector<char>         known(S.n, 0);
    std::vector<unsigned int> unknowns;
    for (unsigned int i = 0; i < iterate.laws.size(); ++i)
      {
        const LinearizedLaw<dim> &law = iterate.laws[i];
        const unsigned int        n   = factor->position(i, 0);
        for (unsigned int k = n; k < factor->position(i + 1, 0); ++k)
          {
            if (law.phase != Phase::open && k == n)
              v[k] = law.normal_step;
            else if (law.phase == Phase::stick)
              v[k] = law.tangential_step[k - n - 1];
            else
              {
                unknowns.push_back(k);
                rhs.push_back(law.phase == Phase::open ? iterate.r[k]
                                                       : law.rhs[k - n - 1]);
                continue;
              }
            known[k] = 1;
          }
      }

    std::vector<double> Sv(S.n, 0.);
    for (std::size_t j = 0; j < S.n; ++j)
      if (known[j] && v[j] != 0)
        for (std::size_t i = 0; i < S.n; ++i)
          Sv[i] += S(i, j) * v[j];
    DenseMatrix K(unknowns.size());
    for (std::size_t j = 0; j < K.n; ++j)
      for (std::size_t i = 0; i < K.n; ++i)
        K(i, j) = S(unknowns[i], unknowns[j]);
    for (std::size_t i = 0; i < K.n; ++i)
      rhs[i] -= Sv[unknowns[i]];
    // Rows of sliding nodes.
    for (std::size_t i = 0, node = 0; i < K.n; ++i)
      {
        while (factor->position(node + 1, 0) <= unknowns[i])
          ++node;
        const LinearizedLaw<dim> &law = iterate.laws[node];
        if (law.phase != Phase::slip)
          continue;
        const unsigned int n     = factor->position(node, 0);
        const unsigned int t     = unknowns[i] - n - 1;
        const double       slope = law.slope[t];
        rhs[i] += slope * Sv[n];
        for (std::size_t j = 0; j < K.n; ++j)
          K(i, j) -= slope * S(n, unknowns[j]);
        for (unsigned int s = 0; s + 1 < factor->position(node + 1, 0) - n; ++s)
          K(i, i - t + s) += law.second[t * (dim - 1) + s];
      }
    solve_dense(K, rhs);
    for (std::size_t i = 0; i < K.n; ++i)
      v[unknowns[i]] = rhs[i];
    return v;
  }



  // Full steps as long as they do not make matters worse than they have been
  // in the last few steps, then shorter ones. If these fail, too, the bounds of
  // friction are frozen for a few steps: a convex problem, the solution of
  // which is one step of the damped fixed point iteration.
  template <int dim>
  bool
  NewtonDirect<dim>::minimize(Iterate        &iterate,
                              BaselineReport &report,
                              const Watch    &watch) const
  {
    const unsigned int  memory = 5, n_frozen = 4;
    std::deque<double>  violations;
    std::vector<double> bounds;
    unsigned int        frozen = 0;
    while (report.iterations < maximum_steps)
      {
        const std::vector<double> v = newton_step(iterate);
        ++report.iterations;
        const std::vector<double> x        = iterate.x;
        const double              largest  = violations.empty()
                        ? 1e300
                        : *std::max_element(violations.begin(), violations.end());
        bool                      accepted = false;
        for (double length = 1.; length > 0.05 && !accepted; length /= 2)
          {
            for (std::size_t i = 0; i < x.size(); ++i)
              iterate.x[i] = x[i] + length * v[i];
            evaluate(iterate, frozen > 0 ? &bounds : nullptr);
            accepted = iterate.violation <= (1 - 1e-4 * length) * largest;
          }
        if (watch)
          watch([&]() { return displacement(iterate.x); });
        if (!std::isfinite(iterate.violation))
          return false;
        if (frozen == 0 && iterate.violation <= 1e-9 * iterate.largest_force)
          return true;

        if (frozen > 0 &&
            (--frozen == 0 ||
             iterate.violation <= 1e-8 * iterate.largest_force))
          {
            frozen = 0;
            violations.clear();
            evaluate(iterate);
          }
        else if (!accepted)
          {
            frozen = n_frozen;
            violations.clear();
            bounds.resize(iterate.laws.size());
            for (unsigned int i = 0; i < bounds.size(); ++i)
              bounds[i] = F *
                rotated.problem.contact[factor->nodes()[i]].friction_share *
                std::max(0., iterate.r[factor->position(i, 0)]);
            evaluate(iterate, &bounds);
          }
        else
          {
            violations.push_back(iterate.violation);
            if (violations.size() > memory)
              violations.pop_front();
          }
      }
    return false;
  }



  template <int dim>
  VectorType
  NewtonDirect<dim>::displacement(const std::vector<double> &x) const
  {
    VectorType u(rotated.problem.constraints.partitioner());
    factor->solve(u, x);
    rotated.from_frames(u);
    rotated.problem.constraints.impose(u);
    return u;
  }



  template <int dim>
  unsigned int
  NewtonDirect<dim>::choose_penetrating(const VectorType &u)
  {
    const auto  &contact = rotated.problem.contact;
    double       scale   = 0;
    unsigned int n       = 0;
    for (const ContactNode<dim> &node : contact)
      scale = std::max({scale,
                        std::abs(normal_component(node, u)),
                        std::abs(normal_component(node, u) - node.gap)});
    std::vector<char> penetrating(chosen.size(), 0);
    for (unsigned int p = 0; p < contact.size(); ++p)
      if (!chosen[p] &&
          normal_component(contact[p], u) - contact[p].gap > 1e-12 * scale)
        {
          penetrating[p] = 1;
          ++n;
        }
    for (unsigned int p = 0; p < chosen.size(); ++p)
      chosen[p] |= penetrating[p];
    return n;
  }



  template <int dim>
  BaselineReport
  NewtonDirect<dim>::solve(VectorType   &u,
                           ContactState &state,
                           const Watch  &watch)
  {
    BaselineReport report;
    const auto    &problem = rotated.problem;
    // An interpolated guess has phases and normal forces, but its residual is
    // noise.
    bool first = true;
    while (true)
      {
        report.memory = std::max(report.memory, factor->memory_consumption());
        VectorType prescribed(problem.constraints.partitioner());
        problem.constraints.impose(prescribed);
        b = factor->reduce(rotated.residual(prescribed));

        VectorType in_frames = u;
        rotated.to_frames(in_frames);
        Iterate iterate;
        iterate.x.resize(factor->n_dense());
        for (unsigned int i = 0; i < factor->nodes().size(); ++i)
          for (unsigned int k = factor->position(i, 0);
               k < factor->position(i + 1, 0);
               ++k)
            iterate.x[k] = in_frames.local_element(
              dim * problem.contact[factor->nodes()[i]].node + k -
              factor->position(i, 0));
        evaluate(iterate);
        if (first)
          for (unsigned int i = 0; i < factor->nodes().size(); ++i)
            {
              const unsigned int      p    = factor->nodes()[i];
              const ContactNode<dim> &node = problem.contact[p];
              const NodeValue<dim>    r    = at_node(iterate.r, i);
              iterate.laws[i] =
                linearize_guess<dim>(node,
                                     F * node.friction_share,
                                     state.in_contact(p),
                                     state.normal_force(p),
                                     in_frames.begin() + dim * node.node,
                                     r.data());
            }
        first            = false;
        report.converged = minimize(iterate, report, watch);
        u                = displacement(iterate.x);

        std::vector<LinearizedLaw<dim>> laws(problem.contact.size());
        std::vector<double>             normal_forces(laws.size(), 0.);
        for (unsigned int i = 0; i < factor->nodes().size(); ++i)
          {
            laws[factor->nodes()[i]] = iterate.laws[i];
            normal_forces[factor->nodes()[i]] =
              iterate.r[factor->position(i, 0)];
          }
        set_state<dim>(state, laws, normal_forces);
        if (!report.converged || choose_penetrating(u) == 0)
          return report;

        // More of them are likely to follow.
        choose_neighbors(2 * n_layers * report.n_setups);
        ++report.n_setups;
        make_factor();
      }
  }



  template class NewtonDirect<2>;
  template class NewtonDirect<3>;
} // namespace Benchmark
