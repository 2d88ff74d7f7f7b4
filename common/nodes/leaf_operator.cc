#include <common/nodes/leaf_operator.h>

#include <utility>
#include <vector>

namespace Friction
{
  template <int dim>
  LeafOperator<dim>::LeafOperator(NodeBlockMatrix<dim>       &&blocks,
                                  const NodalConstraints<dim> &constraints)
    : matrix(std::move(blocks))
    , partitioner(constraints.partitioner())
  {
    std::vector<unsigned int> coupled;
    std::vector<char>         is_coupled(constraints.n_nodes(), 0);
    for (unsigned int i = 0; i < matrix.n_rows(); ++i)
      for (std::size_t e = matrix.row_begin(i); e < matrix.row_end(i); ++e)
        is_coupled[matrix.column(e)] = 1;
    for (unsigned int i = matrix.n_rows(); i < is_coupled.size(); ++i)
      if (is_coupled[i])
        coupled.push_back(i);
    exchange =
      std::make_unique<GhostExchange>(constraints.numbering(), coupled);
  }



  template <int dim>
  void
  LeafOperator<dim>::check_layout(const VectorType &v) const
  {
    Assert(v.get_partitioner() == partitioner ||
             (v.get_partitioner() != nullptr &&
              v.get_partitioner()->is_compatible(*partitioner)),
           ExcMessage("A vector has not the layout of the leaf mesh; it should "
                      "be made with NodalConstraints::partitioner()."));
    (void)v;
  }



  template <int dim>
  void
  LeafOperator<dim>::update_ghosts(const VectorType &v) const
  {
    check_layout(v);
    exchange->update(const_cast<double *>(v.begin()), dim);
  }



  template <int dim>
  void
  LeafOperator<dim>::vmult(VectorType &Av, const VectorType &v) const
  {
    check_layout(Av);
    Assert(&Av != &v, ExcMessage("A product cannot be put in its argument."));
    update_ghosts(v);
    matrix.vmult(Av.begin(), v.begin());
  }



  template <int dim>
  double
  LeafOperator<dim>::energy_product(const VectorType &v) const
  {
    update_ghosts(v);
    return matrix.energy_product(v.begin());
  }



  template <int dim>
  void
  LeafOperator<dim>::residual(VectorType       &r,
                              const VectorType &f,
                              const VectorType &v) const
  {
    check_layout(r);
    check_layout(f);
    Assert(&r != &v, ExcMessage("A product cannot be put in its argument."));
    update_ghosts(v);
    matrix.residual(r.begin(), f.begin(), v.begin());
  }



  template class LeafOperator<2>;
  template class LeafOperator<3>;
} // namespace Friction
