#include <tests/benchmarks/baselines/coulomb_law.h>

#include <algorithm>
#include <cmath>

namespace Benchmark
{
  namespace
  {
    template <int dim>
    double
    norm(const std::array<double, dim> &v, const unsigned int n)
    {
      double sum = 0;
      for (unsigned int i = 0; i < n; ++i)
        sum += v[i] * v[i];
      return std::sqrt(sum);
    }



    // What the prescribed tangential components add to the slip.
    template <int dim>
    double
    prescribed_slip(const ContactNode<dim> &node, const double *u)
    {
      double sum = 0;
      for (unsigned int t = node.n_free_tangents; t < dim - 1; ++t)
        sum += u[t + 1] * u[t + 1];
      return std::sqrt(sum);
    }



    // Without a point where the direction is lost, friction is smooth:
    // r_T = F r_n u_T/|u| with the prescribed slip in |u|.
    template <int dim>
    void
    linearize_smooth(LinearizedLaw<dim>     &law,
                     const ContactNode<dim> &node,
                     const double            F,
                     const double            tau,
                     const double            prescribed,
                     const double           *u,
                     const double           *r,
                     const double            given_bound = -1.)
    {
      const bool         given = given_bound >= 0;
      const unsigned int n     = node.n_free_tangents;
      double             size  = prescribed * prescribed;
      for (unsigned int t = 0; t < n; ++t)
        size += u[t + 1] * u[t + 1];
      size = std::sqrt(size);
      for (unsigned int s = 0; s < n; ++s)
        {
          law.slope[s] = given ? 0. : F * u[s + 1] / size;
          law.rhs[s] =
            r[s + 1] - u[s + 1] / size * (given ? given_bound : F * r[0]);
          for (unsigned int t = 0; t < n; ++t)
            law.second[s * (dim - 1) + t] = (given ? given_bound : F * tau) /
              size * ((s == t ? 1. : 0.) - u[s + 1] * u[t + 1] / (size * size));
        }
    }
  } // namespace



  template <int dim>
  LinearizedLaw<dim>
  linearize(const ContactNode<dim> &node,
            const double            F,
            const double            c,
            const double           *u,
            const double           *r,
            const double            given_bound)
  {
    LinearizedLaw<dim> law;
    const unsigned int n   = node.n_free_tangents;
    const double       tau = r[0] + c * (u[0] - node.gap);
    if (!(tau > 0))
      {
        double sum = 0;
        for (unsigned int e = 0; e <= n; ++e)
          sum += r[e] * r[e];
        law.violation = std::sqrt(sum);
        return law;
      }

    law.normal_step  = node.gap - u[0];
    double violation = std::pow(c * law.normal_step, 2);
    law.phase        = Phase::slip;
    if (F == 0 || n == 0)
      for (unsigned int t = 0; t < n; ++t)
        {
          law.rhs[t] = r[t + 1];
          violation += r[t + 1] * r[t + 1];
        }
    else if (const double prescribed = prescribed_slip<dim>(node, u))
      {
        linearize_smooth<dim>(law, node, F, tau, prescribed, u, r, given_bound);
        for (unsigned int t = 0; t < n; ++t)
          violation += std::pow(law.rhs[t], 2);
      }
    else
      {
        std::array<double, dim - 1> z{};
        for (unsigned int t = 0; t < n; ++t)
          z[t] = r[t + 1] + c * u[t + 1];
        const double size  = norm<dim - 1>(z, n);
        const bool   given = given_bound >= 0;
        const double bound = given ? given_bound : F * tau;
        if (size <= bound)
          {
            law.phase = Phase::stick;
            for (unsigned int t = 0; t < n; ++t)
              {
                law.tangential_step[t] = -u[t + 1];
                violation += std::pow(c * u[t + 1], 2);
              }
          }
        else
          {
            // At the very limit of slip omega is as good as infinite.
            const double omega =
              n == 1 ? 0. : bound / std::max(size - bound, 1e-10 * size);
            double along = 0;
            for (unsigned int t = 0; t < n; ++t)
              {
                z[t] /= size;
                along += z[t] * r[t + 1];
              }
            for (unsigned int s = 0; s < n; ++s)
              {
                const double across = r[s + 1] - z[s] * along;
                law.slope[s]        = given ? 0. : F * z[s];
                law.rhs[s]          = r[s + 1] + omega * across -
                  z[s] * (given ? given_bound : F * r[0]);
                violation += std::pow(r[s + 1] - bound * z[s], 2);
                for (unsigned int t = 0; t < n; ++t)
                  law.second[s * (dim - 1) + t] =
                    omega * c * ((s == t ? 1. : 0.) - z[s] * z[t]);
              }
          }
      }
    law.violation = std::sqrt(violation);
    return law;
  }



  template <int dim>
  LinearizedLaw<dim>
  linearize_guess(const ContactNode<dim> &node,
                  const double            F,
                  const bool              in_contact,
                  const double            normal_force,
                  const double           *u,
                  const double           *r)
  {
    LinearizedLaw<dim> law;
    if (!in_contact)
      return law;
    law.normal_step         = node.gap - u[0];
    law.phase               = Phase::slip;
    const unsigned int n    = node.n_free_tangents;
    double             slip = 0;
    for (unsigned int t = 0; t < dim - 1; ++t)
      slip += u[t + 1] * u[t + 1];
    if (F == 0)
      for (unsigned int t = 0; t < n; ++t)
        law.rhs[t] = r[t + 1];
    // Rounding in the guess of a sticking node is no slip.
    else if (n > 0 &&
             std::sqrt(slip) > 1e-12 * (std::abs(u[0]) + std::abs(node.gap)))
      linearize_smooth<dim>(
        law, node, F, normal_force, prescribed_slip<dim>(node, u), u, r);
    else if (n > 0)
      law.phase = Phase::stick;
    return law;
  }



  template <int dim>
  std::vector<double>
  contact_stiffness(const RotatedProblem<dim> &rotated,
                    const std::vector<char>   &in_zone)
  {
    const DiscreteProblem<dim> &problem = rotated.problem;
    double                      size    = 0;
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      if (in_zone[p])
        size += problem.contact[p].measure;
    std::vector<double> stiffness;
    for (const ContactNode<dim> &node : problem.contact)
      {
        const auto block = rotated.block(
          node.node, problem.stiffness.blocks().row_begin(node.node));
        stiffness.push_back(
          3. * block[0] *
          std::pow(node.measure / std::max(size, node.measure),
                   1. / (dim - 1)));
      }
    return stiffness;
  }



  template <int dim>
  void
  set_state(ContactState                          &state,
            const std::vector<LinearizedLaw<dim>> &laws,
            const std::vector<double>             &normal_forces)
  {
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        const bool contact = laws[p].phase != Phase::open;
        state.set(p, contact, laws[p].phase == Phase::stick);
        state.set_normal_force(p,
                               contact ? std::max(0., normal_forces[p]) : 0.);
      }
  }



#define INSTANTIATE(dim)                                                               \
  template LinearizedLaw<dim>  linearize(const ContactNode<dim> &,                     \
                                         const double,                                 \
                                         const double,                                 \
                                         const double *,                               \
                                         const double *,                               \
                                         const double);                                \
  template LinearizedLaw<dim>  linearize_guess(const ContactNode<dim> &,               \
                                               const double,                           \
                                               const bool,                             \
                                               const double,                           \
                                               const double *,                         \
                                               const double *);                        \
  template std::vector<double> contact_stiffness(const RotatedProblem<dim> &,          \
                                                 const std::vector<char> &);           \
  template void                set_state<dim>(ContactState &,                          \
                               const std::vector<LinearizedLaw<dim>> &, \
                               const std::vector<double> &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Benchmark
