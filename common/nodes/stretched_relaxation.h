#ifndef friction_nodes_stretched_relaxation_h
#define friction_nodes_stretched_relaxation_h

#include <common/nodes/line_relaxation.h>
#include <common/nodes/plane_relaxation.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>

namespace Friction
{
  /**
   * What is relaxed together where cells are stretched: lines of nodes, and
   * planes of those that are in no line.
   */
  template <int dim>
  class StretchedRelaxation
  {
  public:
    /** Arguments as those of PlaneRelaxation. Collective. */
    StretchedRelaxation(const NodeBlockMatrix<dim> &A,
                        const RelaxedNodes         &nodes,
                        const MPI_Comm              communicator)
      : lines(A, nodes.nodes, nodes.is_held, communicator)
      , planes(A, without_lines(nodes), communicator)
    {}

    /** Of the nodes to be relaxed, over all processes. */
    double
    share_in_lines() const
    {
      return lines.share_of_nodes();
    }

    /** The same in lines or planes. */
    double
    share() const
    {
      return lines.share_of_nodes() +
        (1. - lines.share_of_nodes()) * planes.share_of_nodes();
    }

    /** Those of @p all that are to be relaxed one by one. */
    NodeRanges
    other_nodes(const NodeRanges &all) const
    {
      return planes.other_nodes(lines.other_nodes(all));
    }

    /** See LineRelaxation and PlaneRelaxation. */
    void
    factorise(const Truncation<dim> *truncation = nullptr)
    {
      lines.factorise(truncation);
      planes.factorise(truncation);
    }

    /** Sweeps over lines and then one sweep over planes, whatever their number
     * is: a plane costs several times as much, and a second sweep saves less
     * than it takes. Arguments as those of LineRelaxation::run(). There must be
     * lines or planes. */
    void
    run(const unsigned int n_sweeps,
        const double      *b,
        double            *x,
        GhostExchange     &ghosts,
        double            *residual = nullptr) const
    {
      Assert(share() > 0., dealii::ExcInvalidState());
      const bool has_lines  = lines.has_lines(),
                 has_planes = planes.share_of_nodes() > 0.;
      if (has_lines)
        lines.run(n_sweeps, b, x, ghosts, has_planes ? nullptr : residual);
      if (has_planes)
        planes.run(std::min(1u, n_sweeps), b, x, ghosts, residual);
    }

    std::size_t
    memory_consumption() const
    {
      return lines.memory_consumption() + planes.memory_consumption();
    }

  private:
    LineRelaxation<dim>  lines;
    PlaneRelaxation<dim> planes;

    RelaxedNodes
    without_lines(const RelaxedNodes &nodes) const
    {
      RelaxedNodes others = nodes;
      others.nodes        = lines.other_nodes(nodes.nodes);
      return others;
    }
  };
} // namespace Friction

#endif
