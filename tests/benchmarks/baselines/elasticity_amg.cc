#include <tests/benchmarks/baselines/elasticity_amg.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_MultiVector.h>
#include <Teuchos_ParameterList.hpp>
#include <malloc.h>
#include <ml_MultiLevelPreconditioner.h>

namespace Benchmark
{
  namespace
  {
    // Bytes handed out by the allocator of the GNU library at present. The
    // resident memory of the process would not do: what a solver before has
    // given back is used again without its growing.
    std::size_t
    allocated_memory()
    {
      const auto info = mallinfo2();
      return info.uordblks + info.hblkhd;
    }
  } // namespace



  template <int dim>
  struct ElasticityAmg<dim>::Data
  {
    explicit Data(const int n)
      : communicator(MPI_COMM_SELF)
      , map(n, 0, communicator)
      , in(map, 1)
      , out(map, 1)
    {}

    Epetra_MpiComm                                       communicator;
    Epetra_Map                                           map;
    Epetra_MultiVector                                   in, out;
    std::unique_ptr<Epetra_CrsMatrix>                    matrix;
    std::vector<double>                                  modes;
    std::unique_ptr<ML_Epetra::MultiLevelPreconditioner> ml;
  };



  template <int dim>
  ElasticityAmg<dim>::ElasticityAmg(const RotatedProblem<dim>     &rotated,
                                    const std::vector<Point<dim>> &points,
                                    const std::vector<char>       &fixed,
                                    const ContactBlocks<dim>      &second)
    : inverse_diagonal(dim * rotated.problem.contact.size(), 0.)
    , contact(rotated.problem.contact)
  {
    const std::size_t           before = allocated_memory();
    const NodeBlockMatrix<dim> &A      = rotated.problem.stiffness.blocks();
    std::vector<int>            number(A.n_rows(), -1);
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      {
        bool free = false;
        for (unsigned int d = 0; d < dim; ++d)
          free = free || !fixed[dim * i + d];
        if (free)
          {
            number[i] = nodes.size();
            nodes.push_back(i);
          }
      }
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const unsigned int node = contact[p].node;
        const auto         A_pp = rotated.block(node, A.row_begin(node));
        for (unsigned int e = 0; e < dim; ++e)
          if (fixed[dim * node + e] && !rotated.is_fixed(dim * node + e))
            inverse_diagonal[dim * p + e] = 1. /
              (A_pp[e * dim + e] +
               (second.empty() ? 0. : second[p][e * dim + e]));
      }
    const int n = dim * nodes.size();
    data        = std::make_unique<Data>(n);

    std::vector<int> lengths(n);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        lengths[dim * i + d] = fixed[dim * nodes[i] + d]
          ? 1
          : dim * (A.row_end(nodes[i]) - A.row_begin(nodes[i]));
    data->matrix = std::make_unique<Epetra_CrsMatrix>(
      Copy, data->map, lengths.data(), false);
    std::vector<int>    columns[dim];
    std::vector<double> values[dim];
    for (std::size_t i = 0; i < nodes.size(); ++i)
      {
        for (unsigned int d = 0; d < dim; ++d)
          {
            columns[d].clear();
            values[d].clear();
          }
        for (auto e = A.row_begin(nodes[i]); e < A.row_end(nodes[i]); ++e)
          {
            const unsigned int column = A.column(e);
            if (number[column] < 0)
              continue;
            NodeBlock<dim>     block = rotated.block(nodes[i], e);
            const unsigned int p     = rotated.contact_number(nodes[i]);
            if (column == nodes[i] && !second.empty() &&
                p != numbers::invalid_unsigned_int)
              for (unsigned int k = 0; k < dim * dim; ++k)
                block[k] += second[p][k];
            for (unsigned int d = 0; d < dim; ++d)
              for (unsigned int c = 0; c < dim; ++c)
                if ((!fixed[dim * nodes[i] + d] && !fixed[dim * column + c]) ||
                    (column == nodes[i] && c == d))
                  {
                    columns[d].push_back(dim * number[column] + c);
                    values[d].push_back(block[c * dim + d]);
                  }
          }
        for (unsigned int d = 0; d < dim; ++d)
          data->matrix->InsertGlobalValues(
            dim * i + d, values[d].size(), values[d].data(), columns[d].data());
      }
    data->matrix->FillComplete();
    data->matrix->OptimizeStorage();

    // Translations, and rotations about the middle of the body, in frames.
    constexpr unsigned int n_rotations = dim * (dim - 1) / 2;
    constexpr unsigned int n_modes     = dim + n_rotations;
    Point<dim>             middle;
    for (const unsigned int i : nodes)
      middle += points[i] / static_cast<double>(nodes.size());
    data->modes.resize(static_cast<std::size_t>(n) * n_modes);
    VectorType mode(rotated.problem.constraints.partitioner());
    for (unsigned int m = 0; m < n_modes; ++m)
      {
        mode = 0.;
        for (const unsigned int i : nodes)
          if (m < dim)
            mode.local_element(dim * i + m) = 1.;
          else
            {
              // In the plane of the axes a and b.
              const unsigned int a = (m - dim) % dim, b = (a + 1) % dim;
              mode.local_element(dim * i + a) = -(points[i] - middle)[b];
              mode.local_element(dim * i + b) = (points[i] - middle)[a];
            }
        rotated.to_frames(mode);
        for (std::size_t i = 0; i < nodes.size(); ++i)
          for (unsigned int d = 0; d < dim; ++d)
            data->modes[m * static_cast<std::size_t>(n) + dim * i + d] =
              mode.local_element(dim * nodes[i] + d);
      }

    Teuchos::ParameterList list;
    ML_Epetra::SetDefaults("SA", list);
    list.set("ML output", 0);
    list.set("PDE equations", dim);
    list.set("aggregation: type", "Uncoupled");
    list.set("aggregation: threshold", 1e-4);
    list.set("smoother: type", "Chebyshev");
    list.set("smoother: sweeps", 2);
    list.set("coarse: type", "Amesos-KLU");
    list.set("coarse: max size", 2000);
    list.set("null space: type", "pre-computed");
    list.set("null space: dimension", static_cast<int>(n_modes));
    list.set("null space: vectors", data->modes.data());
    list.set("null space: add default vectors", false);
    data->ml = std::make_unique<ML_Epetra::MultiLevelPreconditioner>(
      *data->matrix, list, true);
    const std::size_t after = allocated_memory();
    memory                  = after > before ? after - before : 0;
  }



  template <int dim>
  ElasticityAmg<dim>::~ElasticityAmg() = default;



  template <int dim>
  void
  ElasticityAmg<dim>::vmult(VectorType &z, const VectorType &r) const
  {
    double *in  = data->in[0];
    double *out = data->out[0];
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        in[dim * i + d] = r.local_element(dim * nodes[i] + d);
    data->ml->ApplyInverse(data->in, data->out);
    z = 0.;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        z.local_element(dim * nodes[i] + d) = out[dim * i + d];
    for (unsigned int p = 0; p < contact.size(); ++p)
      for (unsigned int e = 0; e < dim; ++e)
        if (inverse_diagonal[dim * p + e] != 0)
          z.local_element(dim * contact[p].node + e) =
            inverse_diagonal[dim * p + e] *
            r.local_element(dim * contact[p].node + e);
  }



  template class ElasticityAmg<2>;
  template class ElasticityAmg<3>;
} // namespace Benchmark
