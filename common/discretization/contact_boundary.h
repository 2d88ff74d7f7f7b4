#ifndef friction_discretization_contact_boundary_h
#define friction_discretization_contact_boundary_h

#include <common/nodes/nodal_constraints.h>
#include <common/scene/scene.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <deal.II/fe/mapping.h>

#include <array>
#include <vector>

namespace Friction
{
  /**
   * A node of the possible contact boundary $\Gamma_S$.
   */
  template <int dim>
  struct ContactNode
  {
    /// Local number of the node on the leaf mesh.
    unsigned int node;

    Point<dim> point;

    /// The frame $e_1 = n, e_2, \ldots$ at the node: the unit normal, pointing
    /// from the body to the obstacle, and unit tangents.
    std::array<Tensor<1, dim>, dim> frame;

    /// How far the node may move along its normal, $u_n \le g$. A length.
    double gap;

    /// The lumped boundary measure $m_p = \int_{\Gamma_S} \lambda_p$: nodal
    /// forces divided by it are stresses. A length in 2D, an area in 3D.
    double measure;

    /// The coefficient of friction, as a fraction of the largest one on all
    /// contact boundaries: 1 where it is the same everywhere.
    double friction_share = 1.;

    /// Which of Scene::contact_conditions() is about this node.
    unsigned int condition = 0;

    /// Tresca's law: the normal force of the state that friction reckons with
    /// is given, and not that of the solution.
    bool bound_is_given = false;

    /// The tangential displacement s that friction counts from, a vector in the
    /// tangent plane and a length: slip is $u_T-s$. Zero but in later load
    /// steps.
    Tensor<1, dim> slip_origin;

    /// Number of tangential directions that the node may move in. The tangents
    /// in the frame are sorted: first the free ones, then those in which the
    /// displacement is prescribed.
    unsigned int n_free_tangents;

    const Tensor<1, dim> &
    normal() const
    {
      return frame[0];
    }

    /** For other processes. */
    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &node &gap &measure &friction_share &condition &bound_is_given
        &n_free_tangents;
      for (unsigned int d = 0; d < dim; ++d)
        {
          archive &point[d] & slip_origin[d];
          for (Tensor<1, dim> &vector : frame)
            archive &vector[d];
        }
    }
  };



  /**
   * The nodes of $\Gamma_S$ that can get into contact, on all parts of the
   * boundary that the scene says so of. Hanging nodes follow their masters and
   * carry nothing of their own; their share of the boundary measure goes to the
   * masters. Nodes that are entirely prescribed, and nodes whose normal never
   * meets the obstacle, are left out.
   *
   * Each process has the contact nodes that it owns.
   */
  template <int dim>
  class ContactBoundary
  {
  public:
    /** No nodes. */
    ContactBoundary() = default;

    /**
     * Collective; errors are thrown on all processes.
     * @param hanging  hanging nodes.
     * @param scene    says which parts of the boundary it is, and what they
     *                 may touch.
     * @throws InputError if a node is prescribed to penetrate the obstacle, if
     *         a prescribed component at a contact node has a part in normal
     *         direction, so that contact and prescribed value would compete, if
     *         the coefficient of friction is negative or no number at a node,
     *         or if a node belongs to two contact boundaries, which would give
     *         it two normals, unless all of its components are prescribed.
     */
    ContactBoundary(const Mapping<dim>              &mapping,
                    const DoFHandler<dim>           &dof_handler,
                    const AffineConstraints<double> &hanging,
                    const NodalConstraints<dim>     &constraints,
                    const Scene<dim>                &scene);

    /** Nodes that are known already, for which @p like says which law and
     * coefficient hold. */
    ContactBoundary(const std::vector<ContactNode<dim>> &nodes,
                    const ContactBoundary               &like)
      : nodes(nodes)
      , coefficient(like.coefficient)
      , law(like.law)
    {}

    /** From now on friction counts slip from the tangential part of @p u, the
     * displacement that an earlier load step has ended with. */
    void set_slip_origin(const VectorType &u);

    unsigned int
    size() const
    {
      return nodes.size();
    }

    /** The largest coefficient of friction at the nodes of all processes, that
     * of the scene where it does not vary. */
    double
    largest_coefficient() const
    {
      return coefficient;
    }

    /** That of Coulomb if there is any such friction, otherwise that of Tresca,
     * or none. */
    FrictionLaw
    friction_law() const
    {
      return law;
    }

    const ContactNode<dim> &
    operator[](const unsigned int p) const
    {
      return nodes[p];
    }

    typename std::vector<ContactNode<dim>>::const_iterator
    begin() const
    {
      return nodes.begin();
    }

    typename std::vector<ContactNode<dim>>::const_iterator
    end() const
    {
      return nodes.end();
    }

  private:
    std::vector<ContactNode<dim>> nodes;
    double                        coefficient = 0.;
    FrictionLaw                   law         = FrictionLaw::none;

    void find_friction(const NodalConstraints<dim> &constraints,
                       const Scene<dim>            &scene);

    void add_node(ContactNode<dim>             node,
                  const NodalConstraints<dim> &constraints,
                  const Scene<dim>            &scene);
  };



  /** The normal component of the value at a contact node. */
  template <int dim>
  double
  normal_component(const ContactNode<dim> &p, const VectorType &v)
  {
    double sum = 0;
    for (unsigned int d = 0; d < dim; ++d)
      sum += p.normal()[d] * v.local_element(dim * p.node + d);
    return sum;
  }

  /** Moves a contact node out of the obstacle, along its normal. Returns how
   * far it was in it, which is not positive if it was not. */
  template <int dim>
  double
  move_out_of_obstacle(const ContactNode<dim> &p, VectorType &u)
  {
    const double excess = normal_component(p, u) - p.gap;
    if (excess > 0)
      for (unsigned int d = 0; d < dim; ++d)
        u.local_element(dim * p.node + d) -= excess * p.normal()[d];
    return excess;
  }

  /** The tangential components of the value at a contact node, in its frame. */
  template <int dim>
  std::array<double, dim - 1>
  tangential_components(const ContactNode<dim> &p, const VectorType &v)
  {
    std::array<double, dim - 1> result{};
    for (unsigned int t = 1; t < dim; ++t)
      for (unsigned int d = 0; d < dim; ++d)
        result[t - 1] += p.frame[t][d] * v.local_element(dim * p.node + d);
    return result;
  }

  /** The slip $u_T-s$ at a contact node, in its frame: what friction acts
   * against. */
  template <int dim>
  std::array<double, dim - 1>
  slip_components(const ContactNode<dim> &p, const VectorType &u)
  {
    std::array<double, dim - 1> result{};
    for (unsigned int t = 1; t < dim; ++t)
      for (unsigned int d = 0; d < dim; ++d)
        result[t - 1] += p.frame[t][d] *
          (u.local_element(dim * p.node + d) - p.slip_origin[d]);
    return result;
  }
} // namespace Friction

#endif
