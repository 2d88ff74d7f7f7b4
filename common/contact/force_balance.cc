#include <common/compatibility.h>
#include <common/contact/contact_forces.h>
#include <common/contact/force_balance.h>
#include <common/parallel/collective_error.h>
#include <common/parallel/reductions.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Friction
{
  namespace
  {
    // The integral of a load over a cell or a face.
    template <int dim>
    void
    add_integral(Tensor<1, dim>          &sum,
                 const Function<dim>     &load,
                 const FEValuesBase<dim> &values)
    {
      Vector<double> value(dim);
      for (const unsigned int q : values.quadrature_point_indices())
        {
          load.vector_value(values.quadrature_point(q), value);
          for (unsigned int d = 0; d < dim; ++d)
            sum[d] += value[d] * values.JxW(q);
        }
    }



    // With the rules that the loads have been assembled with: expressions are
    // not integrated exactly.
    template <int dim>
    void
    integrate_loads(const Discretization<dim>   &discretization,
                    std::vector<Tensor<1, dim>> &tractions,
                    Tensor<1, dim>              &body_force)
    {
      const Scene<dim> &scene      = discretization.scene();
      const auto       &conditions = scene.traction_conditions();
      const FE_Q<dim>   element(1);
      const UpdateFlags flags = update_quadrature_points | update_JxW_values;
      FEValues<dim>     cell_values(
        discretization.mapping(), element, QGauss<dim>(2), flags);
      FEFaceValues<dim> face_values(
        discretization.mapping(), element, QGauss<dim - 1>(4), flags);
      for (const auto &cell : discretization.dof_handler()
                                .get_triangulation()
                                .active_cell_iterators())
        if (cell->is_locally_owned())
          {
            if (scene.body_force() != nullptr)
              {
                cell_values.reinit(cell);
                add_integral(body_force, *scene.body_force(), cell_values);
              }
            if (!conditions.empty() && cell->at_boundary())
              for (const unsigned int f : cell->face_indices())
                for (unsigned int i = 0; i < conditions.size(); ++i)
                  if (cell->at_boundary(f) &&
                      cell->face(f)->boundary_id() == conditions[i].boundary_id)
                    {
                      face_values.reinit(cell, f);
                      add_integral(
                        tractions[i], *conditions[i].traction, face_values);
                    }
          }
    }



    template <int dim>
    Tensor<1, dim>
    sum_of_all(const Tensor<1, dim> &own, const MPI_Comm communicator)
    {
      std::array<double, dim> components;
      for (unsigned int d = 0; d < dim; ++d)
        components[d] = own[d];
      components = sum_over_processes(components, communicator);
      Tensor<1, dim> sum;
      for (unsigned int d = 0; d < dim; ++d)
        sum[d] = components[d];
      return sum;
    }



    template <int dim>
    double
    largest_force(const ForceBalance<dim> &balance)
    {
      double result = 0;
      for (const ForceOnBody<dim> &force : balance.forces)
        result = std::max({result, force.total.norm(), std::abs(force.normal)});
      return result;
    }
  } // namespace



  template <int dim>
  Tensor<1, dim>
  ForceBalance<dim>::sum() const
  {
    Tensor<1, dim> result;
    for (const ForceOnBody<dim> &force : forces)
      result += force.total;
    return result;
  }



  template <int dim>
  double
  ForceBalance<dim>::imbalance() const
  {
    const double unit = largest_force(*this);
    return unit > 0 ? sum().norm() / unit : 0.;
  }



  template <int dim>
  std::string
  ForceBalance<dim>::describe() const
  {
    const double       negligible = 1e-6 * largest_force(*this);
    std::ostringstream text;
    text.precision(6);
    const auto number = [&](const double x) {
      return std::abs(x) < negligible ? 0. : x;
    };
    const auto print = [&](const Tensor<1, dim> &force) {
      for (unsigned int d = 0; d < dim; ++d)
        text << (d == 0 ? "(" : ", ") << number(force[d]);
      text << ')';
    };
    text << "Forces on the body: ";
    for (unsigned int i = 0; i < forces.size(); ++i)
      {
        text << (i == 0 ? "" : "; ") << forces[i].description << ' ';
        print(forces[i].total);
        if (forces[i].is_contact)
          {
            text << ", normal " << number(forces[i].normal) << ", tangential ";
            print(forces[i].tangential);
          }
        if (forces[i].is_platen)
          {
            text << ", moved by (";
            for (unsigned int d = 0; d < dim; ++d)
              text << (d == 0 ? "" : ", ") << forces[i].moved[d];
            text << ')';
          }
      }
    text.precision(1);
    text << ". They balance to " << std::scientific << imbalance()
         << " of the largest.";
    return text.str();
  }



  template <int dim>
  std::vector<std::set<unsigned int>>
  nodes_of_conditions(const Discretization<dim> &discretization)
  {
    const NodalConstraints<dim> &constraints = discretization.constraints();
    const auto &conditions = discretization.scene().dirichlet_conditions();
    std::vector<std::set<unsigned int>> nodes(conditions.size());
    for (const auto &cell :
         discretization.dof_handler().active_cell_iterators())
      if (!cell->is_artificial() && cell->at_boundary())
        for (const unsigned int f : cell->face_indices())
          for (unsigned int i = 0; i < conditions.size(); ++i)
            if (cell->at_boundary(f) &&
                cell->face(f)->boundary_id() == conditions[i].boundary_id)
              for (unsigned int v = 0; v < cell->face(f)->n_vertices(); ++v)
                {
                  const unsigned int node =
                    constraints.node_of_dof(cell->vertex_dof_index(
                      GeometryInfo<dim>::face_to_cell_vertices(f, v), 0));
                  if (node < constraints.n_owned_nodes())
                    nodes[i].insert(node);
                }
    return nodes;
  }



  template <int dim>
  std::vector<unsigned int>
  find_holders(const Discretization<dim> &discretization)
  {
    const auto &conditions = discretization.scene().dirichlet_conditions();
    std::vector<unsigned int> holders(
      dim * discretization.constraints().n_owned_nodes(), conditions.size());
    const auto nodes = nodes_of_conditions(discretization);
    for (unsigned int i = 0; i < conditions.size(); ++i)
      for (const unsigned int node : nodes[i])
        for (unsigned int d = 0; d < dim; ++d)
          if (conditions[i].components[d])
            holders[dim * node + d] = std::min(holders[dim * node + d], i);
    return holders;
  }



  template <int dim>
  ForceBalance<dim>
  force_balance(const Discretization<dim> &discretization,
                const VectorType          &residual)
  {
    const Scene<dim>            &scene       = discretization.scene();
    const NodalConstraints<dim> &constraints = discretization.constraints();

    // Of this process: what obstacles do, and -r where displacements are
    // prescribed, which is not among their directions. The last reaction is
    // that of pinned points.
    const auto                   &conditions = scene.contact_conditions();
    std::vector<ForceOnBody<dim>> contacts(conditions.size());
    std::vector<Tensor<1, dim>> reactions(scene.dirichlet_conditions().size() +
                                          1);
    const std::vector<unsigned int> holders = find_holders(discretization);
    for (const ContactNode<dim> &node : discretization.contact())
      {
        const Tensor<1, dim> force   = contact_force(node, residual);
        ForceOnBody<dim>    &contact = contacts[node.condition];
        contact.total += force;
        contact.normal -= force * node.normal();
        contact.tangential += tangential_part(node, force);
      }
    for (unsigned int node = 0; node < constraints.n_owned_nodes(); ++node)
      if (!constraints.is_hanging(node))
        for (unsigned int d = 0; d < dim; ++d)
          if (constraints.is_prescribed(node, d))
            reactions[holders[dim * node + d]][d] -=
              residual.local_element(dim * node + d);

    std::vector<Tensor<1, dim>> tractions(scene.traction_conditions().size());
    Tensor<1, dim>              body_force;
    const MPI_Comm              communicator = constraints.communicator();
    on_all_processes(communicator, [&]() {
      integrate_loads(discretization, tractions, body_force);
    });

    ForceBalance<dim> balance;
    const auto        add = [&](const std::string    &name,
                         const std::string    &description,
                         const Tensor<1, dim> &own) {
      ForceOnBody<dim> force;
      force.name        = name;
      force.description = description;
      force.total       = sum_of_all(own, communicator);
      balance.forces.push_back(force);
    };
    for (unsigned int i = 0; i < conditions.size(); ++i)
      if (conditions[i].has_boundary())
        {
          const std::string number = std::to_string(conditions[i].number);
          add(i == 0 ? "contact" : "contact_" + number,
              conditions.size() == 1
                ? "of the obstacle"
                : "of '" + conditions[i].obstacle_section() + "'",
              contacts[i].total);
          ForceOnBody<dim> &force = balance.forces.back();
          force.is_contact        = true;
          force.normal = sum_over_processes(contacts[i].normal, communicator);
          force.tangential = sum_of_all(contacts[i].tangential, communicator);
        }
    for (unsigned int i = 0; i < scene.dirichlet_conditions().size(); ++i)
      {
        const std::string id =
          std::to_string(scene.dirichlet_conditions()[i].boundary_id);
        add("held_" + id, "of what holds boundary " + id, reactions[i]);
        if (const auto &platen = scene.dirichlet_conditions()[i].platen)
          {
            balance.forces.back().is_platen = true;
            balance.forces.back().moved     = *platen->position;
          }
      }
    if (!scene.pinned_points().empty())
      add("pinned", "of what pins points", reactions.back());
    for (unsigned int i = 0; i < tractions.size(); ++i)
      {
        const std::string id =
          std::to_string(scene.traction_conditions()[i].boundary_id);
        add(
          "traction_" + id, "of the traction on boundary " + id, tractions[i]);
      }
    if (scene.body_force() != nullptr)
      add("body_force", "of the body force", body_force);
    return balance;
  }



  template struct ForceBalance<2>;
  template struct ForceBalance<3>;
  template std::vector<std::set<unsigned int>>
  nodes_of_conditions(const Discretization<2> &);
  template std::vector<std::set<unsigned int>>
  nodes_of_conditions(const Discretization<3> &);
  template std::vector<unsigned int> find_holders(const Discretization<2> &);
  template std::vector<unsigned int> find_holders(const Discretization<3> &);
  template ForceBalance<2>           force_balance(const Discretization<2> &,
                                                   const VectorType &);
  template ForceBalance<3>           force_balance(const Discretization<3> &,
                                                   const VectorType &);
} // namespace Friction
