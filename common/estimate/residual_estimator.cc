#include <common/compatibility.h>
#include <common/discretization/multilinear_cell.h>
#include <common/discretization/volumetric_strain.h>
#include <common/estimate/residual_estimator.h>
#include <common/parallel/collective_error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    using namespace Multilinear;

    // The residuals of Q1 elements need first and second derivatives of the
    // displacement, on both sides of each face.
    template <int dim>
    class Estimator
    {
    public:
      using CellIterator = typename DoFHandler<dim>::active_cell_iterator;

      Estimator(const Mapping<dim>          &mapping,
                const DoFHandler<dim>       &dof_handler,
                const EstimatorProblem<dim> &problem,
                const VectorType            &displacement,
                const EstimatorContact      &contact);

      ErrorEstimate run();

    private:
      static constexpr unsigned int n_face_corners =
        GeometryInfo<dim>::vertices_per_face;

      // One place or number for each corner of a face.
      template <typename T>
      using OnFace = std::array<T, n_face_corners>;

      void gather_displacements();

      CellValues<dim> values_of(const CellIterator &cell) const;

      void add_cell(const CellIterator &cell, const CellValues<dim> &values);

      void add_interior_face(const CellIterator    &cell,
                             const CellValues<dim> &values,
                             const unsigned int     f);

      void add_jump(const CellIterator    &cell,
                    const CellValues<dim> &values,
                    const unsigned int     f,
                    const CellIterator    &neighbor,
                    const CellValues<dim> &neighbor_values);

      OnFace<Point<dim>> face_in_neighbor(const CellIterator &cell,
                                          const unsigned int  f,
                                          const CellIterator &neighbor) const;

      void add_boundary_face(const CellIterator    &cell,
                             const CellValues<dim> &values,
                             const unsigned int     f);

      void add_complementarity(const CellIterator                       &cell,
                               const unsigned int                        f,
                               const OnFace<Point<dim>>                 &places,
                               const std::array<double, n_face_corners> &JxW);

      // Book a contribution both where and why it arises, and the part of it
      // that is certain: see ErrorEstimate::lower_bound.
      void add(const CellIterator &cell,
               const double        value,
               const double        certain_part,
               double             &share);

      double square_of_rounding(const CellIterator &cell) const;

      // The stress in a cell of this material, times a normal.
      Tensor<1, dim> stress_times_normal(const CellIterator   &cell,
                                         const Material       &material,
                                         const Tensor<2, dim> &gradient,
                                         const Tensor<1, dim> &normal) const;

      const DoFHandler<dim>       &dof_handler;
      const EstimatorProblem<dim> &problem;
      const VectorType            &displacement;
      const EstimatorContact      &contact;

      const VolumetricStrainField<dim> volumetric_strain;

      // Two points per direction integrate the residuals of Q1 elements exactly
      // on parallelograms, and data with an error that is of higher order.
      // There are as many as corners.
      const QGauss<dim>     quadrature;
      const QGauss<dim - 1> face_quadrature;

      // By vertex of the mesh.
      const std::vector<Point<dim>> &vertices;
      std::vector<Tensor<1, dim>>    displacements;

      // Scratch.
      std::vector<Vector<double>> body_forces;
      std::vector<Vector<double>> tractions;

      Vector<double> squared_errors;
      ErrorEstimate  estimate;
      double         energy = 0., certain = 0.;
    };



    // What the estimate may be over the error on squares and cubes, for
    // solutions whose second derivatives do not change from cell to cell. If
    // only $u_{i,jj}$ do not vanish, the square of that is 12 times the largest
    // eigenvalue of $2ww^T+\operatorname{diag}(1,q)$ in the plane with
    // $q=\mu/(\lambda+2\mu)$ and $w=(1,\sqrt q)$, and of
    // $3ww^T+\sqrt2\operatorname{diag}(1,q,q)$ in space, with
    // $w=(1,\sqrt q,\sqrt q)$: $6.80^2$ and $9.22^2$ for $\lambda=0$, less for
    // larger ones, in which material's part below is taken off already.
    template <int dim>
    constexpr double largest_ratio = dim == 2 ? 7. : 9.3;



    // A residual is at most the error times the norm of the stiffness, where
    // the estimate divides by the smallest stiffness.
    double
    certain_part_of_material(const Material &material)
    {
      return 2. * material.mu() /
        (2. * material.mu() + std::max(0., material.lambda()));
    }



    // And a test function that sees a residual on a side of a cell, or in it,
    // must fall to zero within the cell's width, where the estimate has the
    // length of the side or of the cell. (Their diameters are those of the
    // squares and cubes that the constants below are for.)
    double
    certain_part_of_side(const double width, const double diameter, const int n)
    {
      return std::min(1., width * std::sqrt(double(n)) / diameter);
    }



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
      , volumetric_strain(mapping, dof_handler, problem.materials, displacement)
      , quadrature(2)
      , face_quadrature(2)
      , vertices(dof_handler.get_triangulation().get_vertices())
      , displacements(vertices.size())
      , body_forces(quadrature.size(), Vector<double>(dim))
      , tractions(face_quadrature.size(), Vector<double>(dim))
      , squared_errors(dof_handler.get_triangulation().n_active_cells())
    {
      Assert(dof_handler.get_fe().degree == 1, ExcNotImplemented());
      gather_displacements();
    }



    // A vertex has several cells, which are asked for it several times; so look
    // its degrees of freedom up once.
    template <int dim>
    void
    Estimator<dim>::gather_displacements()
    {
      std::vector<bool> known(displacements.size());
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (!cell->is_artificial())
          for (const unsigned int v : cell->vertex_indices())
            {
              const unsigned int vertex = cell->vertex_index(v);
              if (!known[vertex])
                for (unsigned int c = 0; c < dim; ++c)
                  displacements[vertex][c] =
                    displacement(cell->vertex_dof_index(v, c));
              known[vertex] = true;
            }
    }



    template <int dim>
    CellValues<dim>
    Estimator<dim>::values_of(const CellIterator &cell) const
    {
      std::array<typename CellValues<dim>::Values, CellValues<dim>::n_corners>
        corners;
      for (const unsigned int v : cell->vertex_indices())
        {
          const unsigned int vertex = cell->vertex_index(v);
          const Point<dim>  &place  = vertices[vertex];
          for (unsigned int c = 0; c < dim; ++c)
            {
              corners[v][c]       = place[c];
              corners[v][dim + c] = displacements[vertex][c];
            }
        }
      return CellValues<dim>(corners);
    }



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
              const CellValues<dim> values = values_of(cell);
              add_cell(cell, values);
              for (const unsigned int f : cell->face_indices())
                if (cell->at_boundary(f))
                  add_boundary_face(cell, values, f);
                else
                  add_interior_face(cell, values, f);
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
      estimate.lower_bound =
        std::sqrt(Utilities::MPI::sum(certain, communicator)) /
        largest_ratio<dim>;

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
          u = std::max(u, std::abs(displacements[cell->vertex_index(v)][c]));
      return 1e-18 * 2. * problem.materials.of(cell).mu() * u * u *
        (dim == 2 ? 1. : cell->diameter());
    }



    template <int dim>
    void
    Estimator<dim>::add(const CellIterator &cell,
                        const double        value,
                        const double        certain_part,
                        double             &share)
    {
      squared_errors(cell->active_cell_index()) += value;
      share += value;
      certain += certain_part * value;
    }



    template <int dim>
    Tensor<1, dim>
    Estimator<dim>::stress_times_normal(const CellIterator   &cell,
                                        const Material       &material,
                                        const Tensor<2, dim> &gradient,
                                        const Tensor<1, dim> &normal) const
    {
      return material.mu() * (gradient * normal + normal * gradient) +
        material.lambda() *
        volumetric_strain.value(cell, material, trace(gradient)) * normal;
    }



    // The divergence of the stress,
    // $\mu\Delta u+(\lambda+\mu)\nabla\operatorname{div}u$. Bilinear functions
    // have mixed second derivatives, so this is not zero. The pressure has a
    // gradient in a cell only if it is that of a pointwise volumetric strain.
    //
    // With unit coordinates $\xi_a$ and $u_{,ab}$ the derivatives with respect
    // to them the second derivatives of u are the sums over a and b of
    // $(u_{,ab}-\nabla u\,x_{,ab})\otimes\nabla\xi_a\otimes\nabla\xi_b$.
    template <int dim>
    void
    Estimator<dim>::add_cell(const CellIterator    &cell,
                             const CellValues<dim> &values)
    {
      const Material &material = problem.materials.of(cell);
      const double    lambda = material.lambda(), mu = material.mu();
      const bool      is_pointwise =
        material.volumetric_strain() == VolumetricStrain::pointwise;
      const double of_gradient = is_pointwise ? lambda + mu : mu;

      if (problem.body_force != nullptr)
        {
          std::vector<Point<dim>> places(quadrature.size());
          for (unsigned int q = 0; q < quadrature.size(); ++q)
            {
              const auto hats = hat_values(quadrature.point(q));
              for (unsigned int v = 0; v < CellValues<dim>::n_corners; ++v)
                places[q] += hats[v] * values.place(v);
            }
          problem.body_force->vector_value_list(places, body_forces);
        }

      double squared_residual = 0., squared_difference = 0.;
      for (unsigned int q = 0; q < quadrature.size(); ++q)
        {
          const Point<dim>      &p = quadrature.point(q);
          const PointOfCell<dim> point(values, p);
          const double           JxW = point.determinant * quadrature.weight(q);

          Tensor<1, dim> residual;
          // Stays zero if there is no body force.
          for (unsigned int i = 0; i < dim; ++i)
            residual[i] = body_forces[q](i);
          for (unsigned int a = 0; a < dim; ++a)
            for (unsigned int b = a + 1; b < dim; ++b)
              {
                // The differences along edges in direction a, differentiated.
                typename CellValues<dim>::Values mixed{};
                const auto signs = hat_derivatives(without(p, a), b - 1);
                for (unsigned int e = 0; e < CellValues<dim>::n_edges; ++e)
                  for (unsigned int c = 0; c < 2 * dim; ++c)
                    mixed[c] += signs[e] * values.edges[a][e][c];

                Tensor<1, dim> second;
                for (unsigned int i = 0; i < dim; ++i)
                  {
                    second[i] = mixed[dim + i];
                    for (unsigned int j = 0; j < dim; ++j)
                      second[i] -= point.gradient[i][j] * mixed[j];
                  }

                // Once in the order a, b and once in the order b, a.
                const Tensor<1, dim> &grad_a = point.unit_gradients[a];
                const Tensor<1, dim> &grad_b = point.unit_gradients[b];
                residual += 2. * mu * (grad_a * grad_b) * second +
                  of_gradient *
                    ((second * grad_b) * grad_a + (second * grad_a) * grad_b);
              }
          squared_residual += residual.norm_square() * JxW;

          const SymmetricTensor<2, dim> strain     = symmetrize(point.gradient);
          const double                  divergence = trace(strain);
          const double                  theta =
            volumetric_strain.value(cell, material, divergence);
          squared_difference +=
            (divergence - theta) * (divergence - theta) * JxW;
          energy +=
            (2. * mu * (strain * strain) + lambda * theta * theta) * JxW;
        }

      const double of_material = certain_part_of_material(material);
      const double diameter    = values.diameter();
      const double of_shape =
        certain_part_of_side(values.width(), diameter, dim);
      add(cell,
          diameter * diameter * squared_residual / (2. * mu),
          of_material * of_shape * of_shape,
          estimate.interior);
      if (!is_pointwise)
        add(cell, 2. * mu * squared_difference, of_material, estimate.interior);
    }



    // Every interior face is integrated once and shared by its two cells. Of
    // two cells of different size the smaller one does the work, of two equal
    // ones the one with the smaller index; but a cell of another process does
    // nothing for us, so then it is always ours.
    template <int dim>
    void
    Estimator<dim>::add_interior_face(const CellIterator    &cell,
                                      const CellValues<dim> &values,
                                      const unsigned int     f)
    {
      if (cell->face(f)->has_children())
        {
          for (unsigned int subface = 0;
               subface < cell->face(f)->n_active_descendants();
               ++subface)
            {
              const CellIterator child =
                cell->neighbor_child_on_subface(f, subface);
              if (!child->is_locally_owned())
                add_jump(child,
                         values_of(child),
                         cell->neighbor_face_no(f),
                         cell,
                         values);
            }
          return;
        }

      const CellIterator neighbor = cell->neighbor(f);
      if (neighbor->level() < cell->level() || !neighbor->is_locally_owned() ||
          cell->active_cell_index() < neighbor->active_cell_index())
        add_jump(cell, values, f, neighbor, values_of(neighbor));
    }



    // The corners of a face of a cell in the unit coordinates of its neighbor,
    // which may be as large as the cell or larger. It depends on their
    // orientations which corner is which, so compare the vertices: those of the
    // neighbor with those of the cell, or of its parent.
    template <int dim>
    auto
    Estimator<dim>::face_in_neighbor(const CellIterator &cell,
                                     const unsigned int  f,
                                     const CellIterator &neighbor) const
      -> OnFace<Point<dim>>
    {
      const auto of_face = corners_of_face<dim>(f);

      // For each corner of the face on that level, that of the neighbor.
      const auto corners_in_neighbor = [&](const auto &cell_of_level) {
        OnFace<Point<dim>> corners;
        for (unsigned int k = 0; k < n_face_corners; ++k)
          for (const unsigned int v : neighbor->vertex_indices())
            if (neighbor->vertex_index(v) ==
                cell_of_level->vertex_index(of_face[k]))
              for (unsigned int d = 0; d < dim; ++d)
                corners[k][d] = side_of_corner(v, d);
        return corners;
      };
      if (neighbor->level() == cell->level())
        return corners_in_neighbor(cell);

      const auto         parent  = cell->parent();
      OnFace<Point<dim>> corners = corners_in_neighbor(parent);

      unsigned int child = 0;
      while (parent->child_index(child) != cell->index())
        ++child;
      OnFace<Point<dim>> result;
      for (unsigned int k = 0; k < n_face_corners; ++k)
        {
          // Within the face of the parent.
          Point<dim - 1> place;
          for (unsigned int d = 0, e = 0; d < dim; ++d)
            if (d != f / 2)
              place[e++] = 0.5 *
                (side_of_corner(child, d) + side_of_corner(of_face[k], d));
          result[k] = interpolate(hat_values(place), corners);
        }
      return result;
    }



    template <int dim>
    void
    Estimator<dim>::add_jump(const CellIterator    &cell,
                             const CellValues<dim> &values,
                             const unsigned int     f,
                             const CellIterator    &neighbor,
                             const CellValues<dim> &neighbor_values)
    {
      const OnFace<Point<dim>> there    = face_in_neighbor(cell, f, neighbor);
      const Material          &material = problem.materials.of(cell),
                     &other_material    = problem.materials.of(neighbor);

      double squared_jump = 0.;
      for (unsigned int q = 0; q < face_quadrature.size(); ++q)
        {
          const Point<dim - 1>  &place = face_quadrature.point(q);
          const PointOfCell<dim> point(values, point_of_face<dim>(f, place));
          const PointOfCell<dim> neighbor_point(
            neighbor_values, interpolate(hat_values(place), there));

          // Normal to the face is the gradient of a unit coordinate.
          const Tensor<1, dim> &conormal = point.unit_gradients[f / 2];
          const double          length   = conormal.norm();

          const Tensor<1, dim> normal = conormal / length;
          const Tensor<1, dim> jump =
            stress_times_normal(cell, material, point.gradient, normal) -
            stress_times_normal(
              neighbor, other_material, neighbor_point.gradient, normal);
          squared_jump += jump.norm_square() * length * point.determinant *
            face_quadrature.weight(q);
        }

      const double mu       = std::max(material.mu(), other_material.mu());
      const double diameter = values.diameter_of_face(f);
      const double share    = 0.5 * diameter * squared_jump / (2. * mu);
      const double certain_part =
        std::min(certain_part_of_material(material),
                 certain_part_of_material(other_material)) *
        certain_part_of_side(
          std::min(values.width(), neighbor_values.width()), diameter, dim - 1);
      for (const CellIterator &side : {cell, neighbor})
        if (side->is_locally_owned())
          add(side, share, certain_part, estimate.jumps);
    }



    template <int dim>
    void
    Estimator<dim>::add_boundary_face(const CellIterator    &cell,
                                      const CellValues<dim> &values,
                                      const unsigned int     f)
    {
      const types::boundary_id id = cell->face(f)->boundary_id();

      // Where the displacement is prescribed, the traction is what it is.
      const auto          fixed = problem.dirichlet.find(id);
      const ComponentMask mask  = fixed != problem.dirichlet.end()
         ? fixed->second
         : ComponentMask(dim, false);
      if (mask.n_selected_components(dim) == dim)
        return;

      const auto             of_face = corners_of_face<dim>(f);
      OnFace<Point<dim>>     places;
      OnFace<Tensor<1, dim>> nodal_tractions;
      const bool             on_contact_boundary =
        problem.contact.count(id) > 0 && contact.traction != nullptr;
      for (unsigned int k = 0; k < n_face_corners; ++k)
        {
          places[k] = values.place(of_face[k]);
          if (on_contact_boundary)
            for (unsigned int c = 0; c < dim; ++c)
              nodal_tractions[k][c] =
                (*contact.traction)(cell->vertex_dof_index(of_face[k], c));
        }

      // On a contact boundary both the given traction and that of the obstacle
      // act.
      const auto prescribed    = problem.tractions.find(id);
      const bool is_prescribed = prescribed != problem.tractions.end();
      if (is_prescribed)
        {
          std::vector<Point<dim>> points;
          for (const Point<dim - 1> &p : face_quadrature.get_points())
            points.push_back(interpolate(hat_values(p), places));
          prescribed->second->vector_value_list(points, tractions);
        }

      const Material                    &material = problem.materials.of(cell);
      double                             squared_residual = 0.;
      std::array<double, n_face_corners> JxW;
      for (unsigned int q = 0; q < face_quadrature.size(); ++q)
        {
          const Point<dim - 1>  &place = face_quadrature.point(q);
          const PointOfCell<dim> point(values, point_of_face<dim>(f, place));
          const Tensor<1, dim>   conormal =
            (f % 2 == 1 ? 1. : -1.) * point.unit_gradients[f / 2];
          const double length = conormal.norm();
          JxW[q] = length * point.determinant * face_quadrature.weight(q);

          Tensor<1, dim> residual =
            interpolate(hat_values(place), nodal_tractions);
          if (is_prescribed)
            for (unsigned int c = 0; c < dim; ++c)
              residual[c] += tractions[q](c);
          residual -= stress_times_normal(
            cell, material, point.gradient, conormal / length);
          for (unsigned int c = 0; c < dim; ++c)
            if (mask[c])
              residual[c] = 0.;
          squared_residual += residual.norm_square() * JxW[q];
        }
      const double diameter = values.diameter_of_face(f);
      add(cell,
          diameter * squared_residual / (2. * material.mu()),
          certain_part_of_material(material) *
            certain_part_of_side(values.width(), diameter, dim - 1),
          on_contact_boundary ? estimate.contact : estimate.tractions);

      if (on_contact_boundary && contact.normal != nullptr &&
          contact.gap_vector != nullptr)
        add_complementarity(cell, f, places, JxW);
    }



    // At the nodes the contact laws hold, between them each quantity is
    // interpolated linearly and their products are not zero. The two corners of
    // an edge that separates contact from an open node are the typical case.
    template <int dim>
    void
    Estimator<dim>::add_complementarity(
      const CellIterator                       &cell,
      const unsigned int                        f,
      const OnFace<Point<dim>>                 &places,
      const std::array<double, n_face_corners> &JxW)
    {
      OnFace<double>         pressure, distance;
      OnFace<Tensor<1, dim>> tangential_traction, slip;
      const auto             of_face = corners_of_face<dim>(f);
      for (unsigned int k = 0; k < n_face_corners; ++k)
        {
          Tensor<1, dim> u, t, n, g;
          for (unsigned int c = 0; c < dim; ++c)
            {
              const types::global_dof_index dof =
                cell->vertex_dof_index(of_face[k], c);

              u[c] = displacement(dof);
              t[c] = (*contact.traction)(dof);
              n[c] = (*contact.normal)(dof);
              g[c] = (*contact.gap_vector)(dof);
            }
          // Interpolated normals of hanging nodes are a little short.
          if (n.norm() > 0.)
            n /= n.norm();

          pressure[k]            = -(t * n);
          distance[k]            = (g - u) * n;
          tangential_traction[k] = t + pressure[k] * n;

          if (contact.slip_origin != nullptr)
            for (unsigned int c = 0; c < dim; ++c)
              u[c] -=
                (*contact.slip_origin)(cell->vertex_dof_index(of_face[k], c));
          slip[k] = u - (u * n) * n;
        }

      const auto &friction = problem.contact.at(cell->face(f)->boundary_id());
      const auto  coefficient = [&](const Point<dim> &place) {
        return friction.varying_coefficient == nullptr
           ? friction.coefficient
           : friction.varying_coefficient->value(place);
      };
      double sum = 0.;
      for (unsigned int q = 0; q < face_quadrature.size(); ++q)
        {
          const auto           hats = hat_values(face_quadrature.point(q));
          const double         p    = interpolate(hats, pressure);
          const double         d    = interpolate(hats, distance);
          const Tensor<1, dim> t    = interpolate(hats, tangential_traction);
          const Tensor<1, dim> s    = interpolate(hats, slip);
          const double         F    = coefficient(interpolate(hats, places));
          sum += (std::max(p, 0.) * std::max(d, 0.) +
                  std::max(0., F * p * s.norm() + t * s)) *
            JxW[q];
        }
      add(cell, sum, 0., estimate.complementarity);
    }
  } // namespace



  double
  ErrorEstimate::relative() const
  {
    return energy_norm > 0. ? total / energy_norm : 0.;
  }



  template <int dim>
  ErrorEstimate
  estimate_error(const Mapping<dim>          &mapping,
                 const DoFHandler<dim>       &dof_handler,
                 const EstimatorProblem<dim> &problem,
                 const VectorType            &displacement,
                 const EstimatorContact      &contact)
  {
    return Estimator<dim>(mapping, dof_handler, problem, displacement, contact)
      .run();
  }



  template ErrorEstimate estimate_error<2>(const Mapping<2> &,
                                           const DoFHandler<2> &,
                                           const EstimatorProblem<2> &,
                                           const VectorType &,
                                           const EstimatorContact &);
  template ErrorEstimate estimate_error<3>(const Mapping<3> &,
                                           const DoFHandler<3> &,
                                           const EstimatorProblem<3> &,
                                           const VectorType &,
                                           const EstimatorContact &);
} // namespace Friction
