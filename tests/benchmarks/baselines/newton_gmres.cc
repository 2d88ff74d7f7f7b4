#include <tests/benchmarks/baselines/newton_gmres.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace Benchmark
{
  namespace
  {
    double
    product(const VectorType &a, const VectorType &b)
    {
      double            sum = 0;
      const auto       *x = a.begin(), *y = b.begin();
      const std::size_t n = a.locally_owned_size();
      for (std::size_t i = 0; i < n; ++i)
        sum += x[i] * y[i];
      return sum;
    }
  } // namespace



  template <int dim>
  NewtonGmres<dim>::NewtonGmres(const DiscreteProblem<dim>    &problem,
                                const std::vector<Point<dim>> &points,
                                const VectorType              &u,
                                const ContactState            &state)
    : rotated(problem)
    , F(problem.effective_coefficient())
    , points(points)
    , laws(problem.contact.size())
    , scaling(problem.contact.size())
  {
    AssertThrow(!problem.has_friction() ||
                  problem.friction_law == FrictionLaw::coulomb,
                ExcMessage("Newton's method knows Coulomb's law only."));
    std::vector<char> zone(problem.contact.size());
    for (unsigned int p = 0; p < zone.size(); ++p)
      zone[p] = state.in_contact(p);
    stiffness = contact_stiffness(rotated, zone);

    VectorType r = rotated.residual(u), in_frames = u;
    rotated.to_frames(in_frames);
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        const ContactNode<dim> &node = problem.contact[p];
        laws[p]                      = linearize_guess<dim>(node,
                                       F * node.friction_share,
                                       state.in_contact(p),
                                       state.normal_force(p),
                                       in_frames.begin() + dim * node.node,
                                       r.begin() + dim * node.node);
      }
    fix_components();
    make_preconditioner();
  }



  template <int dim>
  void
  NewtonGmres<dim>::linearize_all(const VectorType &u, const VectorType &r)
  {
    VectorType in_frames = u;
    rotated.to_frames(in_frames);
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        const ContactNode<dim> &node = rotated.problem.contact[p];
        laws[p]                      = linearize<dim>(node,
                                 F * node.friction_share,
                                 stiffness[p],
                                 in_frames.begin() + dim * node.node,
                                 r.begin() + dim * node.node);
      }
  }



  template <int dim>
  void
  NewtonGmres<dim>::fix_components()
  {
    fixed.resize(rotated.n_dofs());
    for (std::size_t i = 0; i < fixed.size(); ++i)
      fixed[i] = rotated.is_fixed(i);
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        const std::size_t dof = dim * rotated.problem.contact[p].node;
        if (laws[p].phase != Phase::open)
          fixed[dof] = 1;
        if (laws[p].phase == Phase::stick)
          for (unsigned int e = 1; e < dim; ++e)
            fixed[dof + e] = 1;
      }
  }



  template <int dim>
  ContactBlocks<dim>
  NewtonGmres<dim>::second_derivatives() const
  {
    ContactBlocks<dim> blocks(laws.size(), zero_block<dim>());
    for (unsigned int p = 0; p < laws.size(); ++p)
      if (laws[p].phase == Phase::slip)
        for (unsigned int s = 0; s + 1 < dim; ++s)
          for (unsigned int t = 0; t + 1 < dim; ++t)
            blocks[p][(t + 1) * dim + s + 1] =
              laws[p].second[s * (dim - 1) + t];
    return blocks;
  }



  template <int dim>
  void
  NewtonGmres<dim>::make_preconditioner()
  {
    amg.reset();
    amg_second = second_derivatives();
    amg =
      std::make_unique<ElasticityAmg<dim>>(rotated, points, fixed, amg_second);
    scale_preconditioner();
  }



  // With diagonal blocks D of the matrix that M has been made of, and D' of the
  // present one, and their Cholesky factors C and C', what is applied is
  // X M^{-1} X^T with X = C'^{-T} C^T.
  template <int dim>
  void
  NewtonGmres<dim>::scale_preconditioner()
  {
    using Matrix                     = Eigen::Matrix<double, dim, dim>;
    const ContactBlocks<dim> present = second_derivatives();
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        scaling[p] = identity_block<dim>();
        if (present[p] == amg_second[p])
          continue;
        const unsigned int node = rotated.problem.contact[p].node;
        const auto         A    = rotated.block(
          node, rotated.problem.stiffness.blocks().row_begin(node));
        const Eigen::Map<const Matrix> D(A.data()),
          before(amg_second[p].data()), now(present[p].data());
        const Eigen::LLT<Matrix> C(D + before), C_now(D + now);
        const Matrix             X = C_now.matrixU().solve(Matrix(C.matrixU()));
        std::copy(X.data(), X.data() + dim * dim, scaling[p].begin());
      }
  }



  template <int dim>
  void
  NewtonGmres<dim>::precondition(VectorType &z, const VectorType &r) const
  {
    VectorType s(r);
    const auto mask = [&](VectorType &v) {
      for (std::size_t i = 0; i < fixed.size(); ++i)
        if (fixed[i])
          v.local_element(i) = 0.;
    };
    mask(s);
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        double        *v = s.begin() + dim * rotated.problem.contact[p].node;
        NodeValue<dim> Xv{};
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            Xv[i] += scaling[p][i * dim + j] * v[j];
        std::copy(Xv.begin(), Xv.end(), v);
      }
    amg->vmult(z, s);
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        double    *v  = z.begin() + dim * rotated.problem.contact[p].node;
        const auto Xv = times<dim>(scaling[p].data(), v);
        std::copy(Xv.begin(), Xv.end(), v);
      }
    mask(z);
  }



  template <int dim>
  void
  NewtonGmres<dim>::vmult(VectorType &y, const VectorType &x) const
  {
    rotated.vmult(y, x);
    for (unsigned int p = 0; p < laws.size(); ++p)
      if (laws[p].phase == Phase::slip)
        {
          const std::size_t dof = dim * rotated.problem.contact[p].node;
          for (unsigned int s = 0; s + 1 < dim; ++s)
            {
              double sum = -laws[p].slope[s] * y.local_element(dof);
              for (unsigned int t = 0; t + 1 < dim; ++t)
                sum += laws[p].second[s * (dim - 1) + t] *
                  x.local_element(dof + t + 1);
              y.local_element(dof + s + 1) += sum;
            }
        }
    for (std::size_t i = 0; i < fixed.size(); ++i)
      if (fixed[i])
        y.local_element(i) = 0.;
  }



  // Arnoldi's process in the inner product of M^{-1}: with each basis vector q
  // also M^{-1} q is kept, which is what the next one is made of anyway.
  template <int dim>
  unsigned int
  NewtonGmres<dim>::gmres(VectorType       &v,
                          VectorType        R,
                          VectorType        z,
                          const double      target,
                          const VectorType &u,
                          const Watch      &watch) const
  {
    unsigned int            n = 0;
    std::vector<VectorType> Q, Z;
    const auto              combine = [&](const std::vector<double> &H,
                             const std::vector<double> &g,
                             const unsigned int         k) {
      std::vector<double> y(k);
      for (int i = k - 1; i >= 0; --i)
        {
          y[i] = g[i];
          for (unsigned int j = i + 1; j < k; ++j)
            y[i] -= H[j * (restart + 1) + i] * y[j];
          y[i] /= H[i * (restart + 1) + i];
        }
      VectorType sum(v);
      for (unsigned int i = 0; i < k; ++i)
        sum.add(y[i], Z[i]);
      return sum;
    };
    while (true)
      {
        double beta = std::sqrt(std::max(0., product(R, z)));
        if (beta <= target || n >= maximum_iterations)
          return n;
        std::vector<double> H((restart + 1) * restart, 0.), g(restart + 1, 0.),
          cosine(restart), sine(restart);
        g[0] = beta;
        Q.assign(1, R);
        Z.assign(1, z);
        Q[0] /= beta;
        Z[0] /= beta;
        unsigned int k = 0;
        VectorType   w(R);
        while (k < restart)
          {
            vmult(w, Z[k]);
            double *h = &H[k * (restart + 1)];
            for (unsigned int i = 0; i <= k; ++i)
              {
                h[i] = product(w, Z[i]);
                w.add(-h[i], Q[i]);
              }
            VectorType Mw(w);
            precondition(Mw, w);
            const double next = std::sqrt(std::max(0., product(w, Mw)));
            for (unsigned int i = 0; i < k; ++i)
              {
                const double a = h[i], b = h[i + 1];
                h[i]     = cosine[i] * a + sine[i] * b;
                h[i + 1] = -sine[i] * a + cosine[i] * b;
              }
            const double size = std::hypot(h[k], next);
            cosine[k]         = size > 0 ? h[k] / size : 1.;
            sine[k]           = size > 0 ? next / size : 0.;
            h[k]              = size;
            g[k + 1]          = -sine[k] * g[k];
            g[k] *= cosine[k];
            ++k;
            ++n;
            if (watch)
              watch([&]() {
                VectorType trial = combine(H, g, k);
                rotated.from_frames(trial);
                trial += u;
                return trial;
              });
            if (std::abs(g[k]) <= target || next == 0 ||
                n >= maximum_iterations)
              break;
            w /= next;
            Mw /= next;
            Q.push_back(w);
            Z.push_back(Mw);
          }
        const bool done = std::abs(g[k]) <= target;
        VectorType sum  = combine(H, g, k);
        if (done)
          {
            v = sum;
            return n;
          }
        sum -= v;
        vmult(w, sum);
        v += sum;
        R -= w;
        precondition(z, R);
      }
  }



  template <int dim>
  BaselineReport
  NewtonGmres<dim>::solve(VectorType   &u,
                          ContactState &state,
                          const Watch  &watch)
  {
    BaselineReport report;
    report.memory        = amg->memory_consumption();
    VectorType r         = rotated.residual(u), R(r), v(r), z(r);
    double     last_size = 0, last_forcing = 0;
    while (true)
      {
        fix_components();
        scale_preconditioner();

        // What is known of the step, and the right hand side of the rest.
        v        = 0.;
        bool any = false;
        for (unsigned int p = 0; p < laws.size(); ++p)
          if (laws[p].phase != Phase::open)
            {
              const std::size_t dof = dim * rotated.problem.contact[p].node;
              v.local_element(dof)  = laws[p].normal_step;
              for (unsigned int t = 0;
                   t < rotated.problem.contact[p].n_free_tangents;
                   ++t)
                if (laws[p].phase == Phase::stick)
                  v.local_element(dof + t + 1) = laws[p].tangential_step[t];
            }
        for (unsigned int p = 0; p < laws.size(); ++p)
          for (unsigned int e = 0; e < dim; ++e)
            any = any ||
              v.local_element(dim * rotated.problem.contact[p].node + e) != 0;
        R = r;
        for (unsigned int p = 0; p < laws.size(); ++p)
          if (laws[p].phase == Phase::slip)
            for (unsigned int t = 0; t + 1 < dim; ++t)
              R.local_element(dim * rotated.problem.contact[p].node + t + 1) =
                laws[p].rhs[t];
        double known = 0;
        if (any)
          {
            vmult(z, v);
            R -= z;
            for (unsigned int p = 0; p < laws.size(); ++p)
              {
                const unsigned int node = rotated.problem.contact[p].node;
                const auto         A    = rotated.block(
                  node, rotated.problem.stiffness.blocks().row_begin(node));
                for (unsigned int e = 0; e < dim; ++e)
                  known += A[e * dim + e] *
                    std::pow(v.local_element(dim * node + e), 2);
              }
          }
        for (std::size_t i = 0; i < fixed.size(); ++i)
          if (fixed[i])
            R.local_element(i) = 0.;
        precondition(z, R);
        const double size = std::sqrt(std::max(0., product(R, z)) + known);

        double energy = 0;
        {
          VectorType f = rotated.problem.forces;
          rotated.to_frames(f);
          f -= r;
          VectorType in_frames = u;
          rotated.to_frames(in_frames);
          energy = product(in_frames, f);
        }
        const double target = tolerance * std::sqrt(std::max(energy, 1e-300));
        if (!std::isfinite(size))
          return report;
        // Where the slip is tiny a wrong direction of friction costs next to
        // no energy: the law is to hold as such, too.
        double violation = 0, force = 0;
        for (unsigned int p = 0; p < laws.size(); ++p)
          {
            violation             = std::max(violation, laws[p].violation);
            const std::size_t dof = dim * rotated.problem.contact[p].node;
            force = std::max(force, std::abs(r.local_element(dof)));
          }
        const bool lawful = report.iterations > 0 && violation <= 1e-7 * force;
        if (size <= target && lawful)
          {
            report.converged = true;
            break;
          }
        if (report.iterations == maximum_steps)
          break;

        // The forcing term, choice 2 of Eisenstat and Walker with their
        // safeguard, and no more accurately than is needed in the end. More
        // than a hundredth to begin with, as is often recommended, leaves so
        // much in the forces that phases are told wrongly: a third more
        // iterations and twice the steps on the half disc. With large
        // coefficients of friction even that may be too much; steps that lead
        // nowhere become exact ones.
        const double gamma   = 0.9;
        const double largest = report.iterations < 10 ? 1e-2
          : report.iterations < 20                    ? 1e-4
                                                      : 1e-7;
        double       forcing = largest;
        if (report.iterations > 0)
          {
            forcing = gamma * std::pow(size / last_size, 2);
            if (gamma * last_forcing * last_forcing > 0.1)
              forcing = std::max(forcing, gamma * last_forcing * last_forcing);
            forcing = std::min(forcing, largest);
          }
        forcing   = std::max(forcing, std::min(largest, 0.5 * target / size));
        last_size = size;
        last_forcing = forcing;

        ++report.iterations;
        report.inner_iterations += gmres(v, R, z, forcing * size, u, watch);
        rotated.from_frames(v);
        u += v;
        r = rotated.residual(u);
        linearize_all(u, r);
      }

    std::vector<double> normal_forces;
    for (const ContactNode<dim> &node : rotated.problem.contact)
      normal_forces.push_back(r.local_element(dim * node.node));
    set_state<dim>(state, laws, normal_forces);
    return report;
  }



  template class NewtonGmres<2>;
  template class NewtonGmres<3>;
} // namespace Benchmark
