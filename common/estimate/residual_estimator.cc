#include <common/compatibility.h>
#include <common/discretization/volumetric_strain.h>
#include <common/estimate/residual_estimator.h>
#include <common/parallel/collective_error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/symmetric_tensor.h>

#include <deal.II/fe/fe_values.h>

#include <cmath>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    class Estimator
    {
    public:
      using VectorType   = LinearAlgebra::distributed::Vector<double>;
      using CellIterator = typename DoFHandler<dim>::active_cell_iterator;
      using FaceIterator = typename DoFHandler<dim>::face_iterator;

      Estimator(const Mapping<dim>          &mapping,
                const DoFHandler<dim>       &dof_handler,
                const EstimatorProblem<dim> &problem,
                const VectorType            &displacement,
                const EstimatorContact      &contact);

      ErrorEstimate run();

    private:
      void add_cell(const CellIterator &cell);

      void add_interior_face(const CellIterator &cell, const unsigned int f);

      void add_jump(const CellIterator          &cell,
                    const CellIterator          &neighbor,
                    const FEFaceValuesBase<dim> &values,
                    const FEFaceValuesBase<dim> &neighbor_values,
                    const double                 diameter);

      void add_boundary_face(const CellIterator &cell, const unsigned int f);

      void add_complementarity(const CellIterator &cell,
                               const FaceIterator &face);

      // Book a contribution both where and why it arises.
      void add(const CellIterator &cell, const double value, double &share);

      double square_of_rounding(const CellIterator &cell) const;

      Tensor<1, dim> stress_times_normal(const SymmetricTensor<2, dim> &strain,
                                         const double volumetric_strain,
                                         const Tensor<1, dim> &normal) const;

      const DoFHandler<dim>       &dof_handler;
      const EstimatorProblem<dim> &problem;
      const VectorType            &displacement;
      const EstimatorContact      &contact;

      const VolumetricStrainField<dim> volumetric_strain;

      // Turns squared stresses into energies.
      const double scaling;

      const FEValuesExtractors::Vector displacements;

      FEValues<dim>        fe_values;
      FEFaceValues<dim>    face_values;
      FEFaceValues<dim>    neighbor_face_values;
      FESubfaceValues<dim> subface_values;

      // Scratch.
      std::vector<Tensor<3, dim>>          hessians;
      std::vector<SymmetricTensor<2, dim>> cell_strains;
      std::vector<SymmetricTensor<2, dim>> strains;
      std::vector<SymmetricTensor<2, dim>> neighbor_strains;
      std::vector<Tensor<1, dim>>          nodal_tractions;
      std::vector<Vector<double>>          body_forces;
      std::vector<Vector<double>>          tractions;

      Vector<double> squared_errors;
      ErrorEstimate  estimate;
      double         energy = 0.;
    };



    // Two points per direction integrate the residuals of Q1 elements exactly
    // on parallelograms, and data with an error that is of higher order.
    template <int dim>
    Estimator<dim>::Estimator(const Mapping<dim>          &mapping,
                              const DoFHandler<dim>       &dof_handler,
                              const EstimatorProblem<dim> &problem,
                              const VectorType            &displacement,
                              const EstimatorContact      &contact)
      : dof_handler(dof_handler)
      , problem(problem)
      , displacement(displacement)
      , contact(contact)
      , volumetric_strain(
          mapping, dof_handler, problem.volumetric_strain, displacement)
      , scaling(1. / (2. * problem.mu))
      , displacements(0)
      , fe_values(mapping,
                  dof_handler.get_fe(),
                  QGauss<dim>(dof_handler.get_fe().degree + 1),
                  update_gradients | update_hessians |
                    update_quadrature_points | update_JxW_values)
      , face_values(mapping,
                    dof_handler.get_fe(),
                    QGauss<dim - 1>(dof_handler.get_fe().degree + 1),
                    update_values | update_gradients | update_normal_vectors |
                      update_quadrature_points | update_JxW_values)
      , neighbor_face_values(mapping,
                             dof_handler.get_fe(),
                             QGauss<dim - 1>(dof_handler.get_fe().degree + 1),
                             update_gradients)
      , subface_values(mapping,
                       dof_handler.get_fe(),
                       QGauss<dim - 1>(dof_handler.get_fe().degree + 1),
                       update_gradients)
      , hessians(fe_values.n_quadrature_points)
      , cell_strains(fe_values.n_quadrature_points)
      , strains(face_values.n_quadrature_points)
      , neighbor_strains(face_values.n_quadrature_points)
      , nodal_tractions(face_values.n_quadrature_points)
      , body_forces(fe_values.n_quadrature_points, Vector<double>(dim))
      , tractions(face_values.n_quadrature_points, Vector<double>(dim))
      , squared_errors(dof_handler.get_triangulation().n_active_cells())
    {}



    template <int dim>
    ErrorEstimate
    Estimator<dim>::run()
    {
      // Loads are evaluated again, in other points.
      const MPI_Comm communicator =
        Compatibility::mpi_communicator(dof_handler);
      on_all_processes(communicator, [&]() {
        for (const auto &cell : dof_handler.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              add_cell(cell);
              for (const unsigned int f : cell->face_indices())
                if (cell->face(f)->at_boundary())
                  add_boundary_face(cell, f);
                else
                  add_interior_face(cell, f);
            }
      });

      for (double *const share : {&estimate.interior,
                                  &estimate.jumps,
                                  &estimate.tractions,
                                  &estimate.contact,
                                  &estimate.complementarity})
        *share = Utilities::MPI::sum(*share, communicator);

      estimate.total =
        std::sqrt(estimate.interior + estimate.jumps + estimate.tractions +
                  estimate.contact + estimate.complementarity);
      estimate.energy_norm =
        std::sqrt(Utilities::MPI::sum(energy, communicator));

      estimate.cell_errors.reinit(squared_errors.size());
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const double error = squared_errors(cell->active_cell_index());
            if (error > square_of_rounding(cell))
              estimate.cell_errors(cell->active_cell_index()) =
                std::sqrt(error);
          }
      return estimate;
    }



    // A cell that merely moves has stresses that are nothing but rounding. The
    // energy that displacements of this size could have tells them from others.
    template <int dim>
    double
    Estimator<dim>::square_of_rounding(const CellIterator &cell) const
    {
      double u = 0.;
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int c = 0; c < dim; ++c)
          u = std::max(u, std::abs(displacement(cell->vertex_dof_index(v, c))));
      return 1e-18 * 2. * problem.mu * u * u *
        std::pow(cell->diameter(), dim - 2);
    }



    template <int dim>
    void
    Estimator<dim>::add(const CellIterator &cell,
                        const double        value,
                        double             &share)
    {
      squared_errors(cell->active_cell_index()) += value;
      share += value;
    }



    template <int dim>
    Tensor<1, dim>
    Estimator<dim>::stress_times_normal(const SymmetricTensor<2, dim> &strain,
                                        const double          volumetric_strain,
                                        const Tensor<1, dim> &normal) const
    {
      return 2. * problem.mu * (strain * normal) +
        problem.lambda * volumetric_strain * normal;
    }



    // $\operatorname{div}\sigma=\mu\Delta
    // u+(\lambda+\mu)\nabla\operatorname{div}u$. Bilinear functions have mixed
    // second derivatives, so this is not zero. The pressure has a gradient in
    // a cell only if it is that of a pointwise volumetric strain.
    template <int dim>
    void
    Estimator<dim>::add_cell(const CellIterator &cell)
    {
      const double of_gradient = volumetric_strain.is_pointwise()
        ? problem.lambda + problem.mu
        : problem.mu;

      fe_values.reinit(cell);
      fe_values[displacements].get_function_hessians(displacement, hessians);
      fe_values[displacements].get_function_symmetric_gradients(displacement,
                                                                cell_strains);
      if (problem.body_force != nullptr)
        problem.body_force->vector_value_list(fe_values.get_quadrature_points(),
                                              body_forces);

      double squared_residual = 0., squared_difference = 0.;
      for (const unsigned int q : fe_values.quadrature_point_indices())
        {
          Tensor<1, dim> residual;
          for (unsigned int i = 0; i < dim; ++i)
            {
              // Stays zero if there is no body force.
              residual[i] = body_forces[q](i);
              for (unsigned int j = 0; j < dim; ++j)
                residual[i] += problem.mu * hessians[q][i][j][j] +
                  of_gradient * hessians[q][j][j][i];
            }
          squared_residual += residual.norm_square() * fe_values.JxW(q);

          const double divergence = trace(cell_strains[q]);
          const double theta      = volumetric_strain.value(cell, divergence);
          squared_difference +=
            (divergence - theta) * (divergence - theta) * fe_values.JxW(q);
          energy +=
            (2. * problem.mu * cell_strains[q].norm() * cell_strains[q].norm() +
             problem.lambda * theta * theta) *
            fe_values.JxW(q);
        }

      add(cell,
          scaling * cell->diameter() * cell->diameter() * squared_residual,
          estimate.interior);
      if (!volumetric_strain.is_pointwise())
        add(cell, 2. * problem.mu * squared_difference, estimate.interior);
    }



    // Every interior face is integrated once and shared by its two cells. Of
    // two cells of different size the smaller one does the work, of two equal
    // ones the one with the smaller index; but a cell of another process does
    // nothing for us, so then it is always ours.
    template <int dim>
    void
    Estimator<dim>::add_interior_face(const CellIterator &cell,
                                      const unsigned int  f)
    {
      if (cell->face(f)->has_children())
        {
          for (unsigned int subface = 0;
               subface < cell->face(f)->n_active_descendants();
               ++subface)
            {
              const CellIterator child =
                cell->neighbor_child_on_subface(f, subface);
              if (child->is_locally_owned())
                continue;
              face_values.reinit(child, cell->neighbor_face_no(f));
              subface_values.reinit(cell, f, subface);
              add_jump(child,
                       cell,
                       face_values,
                       subface_values,
                       child->face(cell->neighbor_face_no(f))->diameter());
            }
          return;
        }

      const CellIterator neighbor = cell->neighbor(f);
      if (cell->neighbor_is_coarser(f))
        {
          const auto coarse = cell->neighbor_of_coarser_neighbor(f);
          face_values.reinit(cell, f);
          subface_values.reinit(neighbor, coarse.first, coarse.second);
          add_jump(cell,
                   neighbor,
                   face_values,
                   subface_values,
                   cell->face(f)->diameter());
        }
      else if (!neighbor->is_locally_owned() ||
               cell->active_cell_index() < neighbor->active_cell_index())
        {
          face_values.reinit(cell, f);
          neighbor_face_values.reinit(neighbor, cell->neighbor_face_no(f));
          add_jump(cell,
                   neighbor,
                   face_values,
                   neighbor_face_values,
                   cell->face(f)->diameter());
        }
    }



    template <int dim>
    void
    Estimator<dim>::add_jump(const CellIterator          &cell,
                             const CellIterator          &neighbor,
                             const FEFaceValuesBase<dim> &values,
                             const FEFaceValuesBase<dim> &neighbor_values,
                             const double                 diameter)
    {
      values[displacements].get_function_symmetric_gradients(displacement,
                                                             strains);
      neighbor_values[displacements].get_function_symmetric_gradients(
        displacement, neighbor_strains);

      double squared_jump = 0.;
      for (const unsigned int q : values.quadrature_point_indices())
        {
          const SymmetricTensor<2, dim> jump = strains[q] - neighbor_strains[q];
          squared_jump += stress_times_normal(
                            jump,
                            volumetric_strain.jump(cell, neighbor, trace(jump)),
                            values.normal_vector(q))
                            .norm_square() *
            values.JxW(q);
        }

      for (const CellIterator &side : {cell, neighbor})
        if (side->is_locally_owned())
          add(side, 0.5 * scaling * diameter * squared_jump, estimate.jumps);
    }



    template <int dim>
    void
    Estimator<dim>::add_boundary_face(const CellIterator &cell,
                                      const unsigned int  f)
    {
      const FaceIterator       face = cell->face(f);
      const types::boundary_id id   = face->boundary_id();

      // Where the displacement is prescribed, the traction is what it is.
      const auto          fixed = problem.dirichlet.find(id);
      const ComponentMask mask  = fixed != problem.dirichlet.end()
         ? fixed->second
         : ComponentMask(dim, false);
      if (mask.n_selected_components(dim) == dim)
        return;

      face_values.reinit(cell, f);
      face_values[displacements].get_function_symmetric_gradients(displacement,
                                                                  strains);

      const bool on_contact_boundary =
        id == problem.contact_boundary && contact.traction != nullptr;
      const auto prescribed = problem.tractions.find(id);
      if (on_contact_boundary)
        face_values[displacements].get_function_values(*contact.traction,
                                                       nodal_tractions);
      else if (prescribed != problem.tractions.end())
        {
          prescribed->second->vector_value_list(
            face_values.get_quadrature_points(), tractions);
          for (const unsigned int q : face_values.quadrature_point_indices())
            for (unsigned int c = 0; c < dim; ++c)
              nodal_tractions[q][c] = tractions[q](c);
        }
      else
        std::fill(
          nodal_tractions.begin(), nodal_tractions.end(), Tensor<1, dim>());

      double squared_residual = 0.;
      for (const unsigned int q : face_values.quadrature_point_indices())
        {
          Tensor<1, dim> residual = nodal_tractions[q] -
            stress_times_normal(strains[q],
                                volumetric_strain.value(cell,
                                                        trace(strains[q])),
                                face_values.normal_vector(q));
          for (unsigned int c = 0; c < dim; ++c)
            if (mask[c])
              residual[c] = 0.;
          squared_residual += residual.norm_square() * face_values.JxW(q);
        }
      add(cell,
          scaling * face->diameter() * squared_residual,
          on_contact_boundary ? estimate.contact : estimate.tractions);

      if (on_contact_boundary && contact.normal != nullptr &&
          contact.gap_vector != nullptr)
        add_complementarity(cell, face);
    }



    // At the nodes the contact laws hold, between them each quantity is
    // interpolated linearly and their products are not zero. The two corners of
    // an edge that separates contact from an open node are the typical case.
    template <int dim>
    void
    Estimator<dim>::add_complementarity(const CellIterator &cell,
                                        const FaceIterator &face)
    {
      const unsigned int n_vertices = face->n_vertices();

      std::vector<double>         pressure(n_vertices);
      std::vector<double>         distance(n_vertices);
      std::vector<Tensor<1, dim>> tangential_traction(n_vertices);
      std::vector<Tensor<1, dim>> slip(n_vertices);
      for (const unsigned int v : face->vertex_indices())
        {
          Tensor<1, dim> u, t, n, g;
          for (unsigned int c = 0; c < dim; ++c)
            {
              const types::global_dof_index dof = face->vertex_dof_index(v, c);

              u[c] = displacement(dof);
              t[c] = (*contact.traction)(dof);
              n[c] = (*contact.normal)(dof);
              g[c] = (*contact.gap_vector)(dof);
            }
          // Interpolated normals of hanging nodes are a little short.
          if (n.norm() > 0.)
            n /= n.norm();

          pressure[v]            = -(t * n);
          distance[v]            = (g - u) * n;
          tangential_traction[v] = t + pressure[v] * n;
          slip[v]                = u - (u * n) * n;
        }

      const FiniteElement<dim> &fe = dof_handler.get_fe();

      double sum = 0.;
      for (const unsigned int q : face_values.quadrature_point_indices())
        {
          double         p = 0., d = 0.;
          Tensor<1, dim> t, s;
          for (const unsigned int v : face->vertex_indices())
            {
              // The shape function of the vertex, through the cell that
              // face_values lives on.
              double shape = 0.;
              for (const unsigned int w : cell->vertex_indices())
                if (cell->vertex_index(w) == face->vertex_index(v))
                  shape = face_values.shape_value(
                    fe.component_to_system_index(0, w), q);

              p += shape * pressure[v];
              d += shape * distance[v];
              t += shape * tangential_traction[v];
              s += shape * slip[v];
            }
          sum += (std::max(p, 0.) * std::max(d, 0.) +
                  std::max(
                    0., problem.friction_coefficient * p * s.norm() + t * s)) *
            face_values.JxW(q);
        }
      add(cell, sum, estimate.complementarity);
    }
  } // namespace



  double
  ErrorEstimate::relative() const
  {
    return energy_norm > 0. ? total / energy_norm : 0.;
  }



  template <int dim>
  ErrorEstimate
  estimate_error(const Mapping<dim>                               &mapping,
                 const DoFHandler<dim>                            &dof_handler,
                 const EstimatorProblem<dim>                      &problem,
                 const LinearAlgebra::distributed::Vector<double> &displacement,
                 const EstimatorContact                           &contact)
  {
    return Estimator<dim>(mapping, dof_handler, problem, displacement, contact)
      .run();
  }



  template ErrorEstimate
  estimate_error<2>(const Mapping<2> &,
                    const DoFHandler<2> &,
                    const EstimatorProblem<2> &,
                    const LinearAlgebra::distributed::Vector<double> &,
                    const EstimatorContact &);
  template ErrorEstimate
  estimate_error<3>(const Mapping<3> &,
                    const DoFHandler<3> &,
                    const EstimatorProblem<3> &,
                    const LinearAlgebra::distributed::Vector<double> &,
                    const EstimatorContact &);
} // namespace Friction
