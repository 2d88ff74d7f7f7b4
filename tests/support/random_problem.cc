#include <numeric>

#include <tests/support/random_problem.h>

namespace Tests
{
  template <int dim>
  Parameters
  block_parameters(const FrictionLaw law, const double friction_coefficient)
  {
    Parameters p;
    p.scene.geometry        = GeometryKind::rectangle;
    p.scene.size            = std::vector<double>(dim, 1.);
    p.scene.subdivisions    = std::vector<unsigned int>(dim, 1);
    p.scene.size[0]         = 1.5;
    p.scene.subdivisions[0] = (dim == 2 ? 3 : 2);
    p.scene.subdivisions[1] = (dim == 2 ? 2 : 1);
    p.scene.distortion      = .2;

    const unsigned int vertical = (dim == 2 ? 1 : 2);
    p.obstacle.kind             = ObstacleKind::plane;
    p.obstacle.point            = std::vector<double>(dim, 0.);
    p.obstacle.normal           = std::vector<double>(dim, 0.);
    p.obstacle.normal[vertical] = -1.;

    std::vector<std::string> displacement(dim, "0.02");
    displacement[vertical] = "-0.02";
    p.boundary_conditions.displacement.push_back(
      {dim == 2 ? "3" : "5", displacement});

    p.contact.boundary             = (dim == 2 ? "2" : "4");
    p.contact.normal               = ContactNormal::body;
    p.contact.friction_law         = law;
    p.contact.friction_coefficient = friction_coefficient;

    // Such problems are small, and there to test the multigrid method.
    p.solver.condensation = CondensationUse::where_cycles_are_many;
    return p;
  }



  template <int dim>
  Parameters
  curved_parameters(const FrictionLaw law, const double friction_coefficient)
  {
    Parameters p            = block_parameters<dim>(law, friction_coefficient);
    auto      &displacement = p.boundary_conditions.displacement;
    if (dim == 2)
      {
        p.scene.geometry   = GeometryKind::half_disc;
        p.scene.radius     = 1.;
        p.scene.distortion = 0.;
        p.obstacle.point   = {0., -1.};
        p.contact.boundary = "0";
        displacement       = {{"1", {"0.05", "-0.2"}}};
      }
    else
      {
        p.obstacle.kind    = ObstacleKind::rods;
        p.obstacle.centers = {{.75, .5, -3.}};
        p.obstacle.axes    = {{1., 2., 0.}};
        p.obstacle.radii   = {3.};
        p.contact.normal   = ContactNormal::obstacle;
        displacement       = {{"5", {"0.03", "0.02", "-0.06"}}};
      }
    return p;
  }



  template <int dim>
  void
  refine_at_random(Triangulation<dim> &mesh,
                   const unsigned int  n_rounds,
                   const double        density,
                   Random             &random)
  {
    for (unsigned int round = 0; round < n_rounds; ++round)
      {
        for (const auto &cell : mesh.active_cell_iterators())
          {
            const bool at_bottom =
              cell->center()[dim - 1] < .6 * cell->diameter();
            const double dice = random(0., 1.);
            if (dice < (at_bottom ? density : .4 * density))
              cell->set_refine_flag();
            else if (dice > .9)
              cell->set_coarsen_flag();
          }
        mesh.execute_coarsening_and_refinement();
      }
  }



  template <int dim>
  unsigned int
  n_hanging_at_contact(const Discretization<dim>               &discretization,
                       const types::boundary_id                 boundary_id,
                       const std::function<bool(unsigned int)> &holds)
  {
    const auto               &constraints = discretization.constraints();
    const auto               &contact     = discretization.contact();
    std::vector<unsigned int> number(constraints.n_nodes(),
                                     numbers::invalid_unsigned_int);
    for (unsigned int p = 0; p < contact.size(); ++p)
      number[contact[p].node] = p;
    std::vector<char> counts(constraints.n_nodes(), 0);
    for (const auto &cell :
         discretization.dof_handler().active_cell_iterators())
      for (const unsigned int f : cell->face_indices())
        if (cell->at_boundary(f) && cell->face(f)->boundary_id() == boundary_id)
          for (unsigned int v = 0; v < cell->face(f)->n_vertices(); ++v)
            {
              const auto         dof  = cell->face(f)->vertex_dof_index(v, 0);
              const unsigned int node = constraints.node_of_dof(dof);
              if (constraints.is_hanging(node))
                for (const auto &master :
                     *discretization.hanging_nodes().get_constraint_entries(
                       dof))
                  {
                    const unsigned int p =
                      number[constraints.node_of_dof(master.first)];
                    if (p != numbers::invalid_unsigned_int && holds(p))
                      counts[node] = 1;
                  }
            }
    return std::accumulate(counts.begin(), counts.end(), 0u);
  }



  template <int dim>
  RandomProblem<dim>::RandomProblem(const Parameters  &parameters,
                                    const unsigned int n_rounds,
                                    const double       density,
                                    Random            &random)
    : scene(parameters)
    , mesh(make_triangulation<dim>())
    , discretization(scene, *mesh)
  {
    scene.make_coarse_mesh(*mesh);
    refine_at_random<dim>(*mesh, n_rounds, density, random);
    discretize();
  }



  template <int dim>
  void
  RandomProblem<dim>::refine_global(const unsigned int n)
  {
    mesh->refine_global(n);
    discretize();
  }



  template <int dim>
  DiscreteProblem<dim>
  RandomProblem<dim>::friction_problem(const double      coefficient,
                                       const FrictionLaw law) const
  {
    DiscreteProblem<dim> result = discretization.problem();
    result.friction_law         = law;
    result.friction_coefficient = coefficient;
    return result;
  }



  template <int dim>
  unsigned int
  RandomProblem<dim>::n_hanging() const
  {
    unsigned int n = 0;
    for (unsigned int i = 0; i < constraints().n_nodes(); ++i)
      n += constraints().is_hanging(i);
    return n;
  }



  template <int dim>
  unsigned int
  RandomProblem<dim>::n_hanging_at_contact(
    const std::function<bool(unsigned int)> &holds) const
  {
    return Tests::n_hanging_at_contact<dim>(
      discretization, scene.contact_conditions()[0].boundary_id, holds);
  }



  template <int dim>
  unsigned int
  RandomProblem<dim>::n_hanging_with_truncated_master(
    const Truncation<dim> &truncation) const
  {
    unsigned int n = 0;
    for (unsigned int i = 0; i < constraints().n_nodes(); ++i)
      if (constraints().is_hanging(i))
        {
          bool found = false;
          for (const auto &master :
               *discretization.hanging_nodes().get_constraint_entries(
                 constraints().partitioner()->local_to_global(dim * i)))
            {
              const unsigned int m = constraints().node_of_dof(master.first);
              found                = found ||
                (constraints().is_free(m) && !truncation.is_identity(m));
            }
          n += found;
        }
    return n;
  }



  template <int dim>
  void
  RandomProblem<dim>::discretize()
  {
    discretization.set_up();
    discretization.assemble(elasticity<dim>(scene.materials()));
    level_hierarchy = std::make_unique<LevelHierarchy<dim>>(
      discretization.dof_handler(), constraints(), matrix());
  }



  template <int dim>
  Eigen::MatrixXd
  to_dense(const NodeBlockMatrix<dim> &A)
  {
    Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(dim * A.n_rows(), dim * A.n_rows());
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      for (std::size_t e = A.row_begin(i); e < A.row_end(i); ++e)
        {
          const NodeBlock<dim> block = A.value(i, e);
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int r = 0; r < dim; ++r)
              result(dim * i + r, dim * A.column(e) + c) = block[c * dim + r];
        }
    return result;
  }



  VectorType
  to_vector(const Eigen::VectorXd &x, const VectorType &like)
  {
    VectorType result(like);
    for (unsigned int i = 0; i < x.size(); ++i)
      result.local_element(i) = x(i);
    return result;
  }



  Eigen::VectorXd
  to_eigen(const VectorType &v)
  {
    Eigen::VectorXd result(v.locally_owned_size());
    for (unsigned int i = 0; i < result.size(); ++i)
      result(i) = v.local_element(i);
    return result;
  }



  template <int dim>
  Eigen::Matrix<double, dim, 1>
  random_direction(Random &random)
  {
    Eigen::Matrix<double, dim, 1> d;
    do
      for (unsigned int c = 0; c < dim; ++c)
        d(c) = random(-1., 1.);
    while (d.norm() < .1 || d.norm() > 1.);
    return d.normalized();
  }



  template <int dim>
  void
  truncate_at_random(Truncation<dim>   &truncation,
                     const unsigned int node,
                     const unsigned int rank,
                     const double       scale,
                     Random            &random)
  {
    using Matrix    = Eigen::Matrix<double, dim, dim>;
    const auto   d  = random_direction<dim>(random);
    const Matrix dd = d * d.transpose();
    Matrix       T  = Matrix::Zero();
    if (rank == dim)
      T = Matrix::Identity();
    else if (rank == dim - 1)
      T = Matrix::Identity() - dd;
    else if (rank == 1)
      T = dd;
    Matrix root;
    for (unsigned int e = 0; e < dim * dim; ++e)
      root(e) = random(-1., 1.);
    const Matrix omega = scale * T * root * root.transpose() * T;

    NodeBlock<dim> projector, curvature;
    for (unsigned int e = 0; e < dim * dim; ++e)
      {
        projector[e] = T(e);
        curvature[e] = omega(e);
      }
    truncation.set(node, projector, curvature);
  }



  template <int dim>
  Truncation<dim>
  random_truncation(const NodalConstraints<dim> &constraints,
                    const ContactBoundary<dim>  &contact,
                    const double                 scale,
                    Random                      &random)
  {
    Truncation<dim> truncation(constraints);
    for (const ContactNode<dim> &p : contact)
      if (p.n_free_tangents == dim - 1)
        truncate_at_random<dim>(
          truncation, p.node, random.below(dim + 1), scale, random);
    return truncation;
  }



  template <int dim>
  std::pair<Eigen::MatrixXd, Eigen::MatrixXd>
  to_dense(const Truncation<dim> &truncation, const unsigned int n_nodes)
  {
    Eigen::MatrixXd T     = Eigen::MatrixXd::Zero(dim * n_nodes, dim * n_nodes);
    Eigen::MatrixXd omega = T;
    for (unsigned int i = 0; i < n_nodes; ++i)
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int r = 0; r < dim; ++r)
          {
            T(dim * i + r, dim * i + c) = truncation.projector(i)[c * dim + r];
            omega(dim * i + r, dim * i + c) =
              truncation.curvature(i)[c * dim + r];
          }
    return {T, omega};
  }



  // For both dimensions.
#define INSTANTIATE(dim)                                                         \
  template Parameters block_parameters<dim>(const FrictionLaw, const double);    \
  template Parameters curved_parameters<dim>(const FrictionLaw, const double);   \
  template void       refine_at_random(                                          \
          Triangulation<dim> &, const unsigned int, const double, Random &);     \
  template unsigned int n_hanging_at_contact(                                    \
    const Discretization<dim> &,                                                 \
    const types::boundary_id,                                                    \
    const std::function<bool(unsigned int)> &);                                  \
  template struct RandomProblem<dim>;                                            \
  template Eigen::MatrixXd               to_dense(const NodeBlockMatrix<dim> &); \
  template Eigen::Matrix<double, dim, 1> random_direction<dim>(Random &);        \
  template void                          truncate_at_random(Truncation<dim> &,   \
                                                            const unsigned int,  \
                                                            const unsigned int,  \
                                                            const double,        \
                                                            Random &);           \
  template Truncation<dim> random_truncation(const NodalConstraints<dim> &,      \
                                             const ContactBoundary<dim> &,       \
                                             const double,                       \
                                             Random &);                          \
  template std::pair<Eigen::MatrixXd, Eigen::MatrixXd> to_dense(                 \
    const Truncation<dim> &, const unsigned int)

  INSTANTIATE(2);
  INSTANTIATE(3);
} // namespace Tests
