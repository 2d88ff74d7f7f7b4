#ifndef friction_parallel_reductions_h
#define friction_parallel_reductions_h

#include <common/parallel/phase_costs.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <vector>

namespace Friction
{
  /**
   * Sums over all processes that know where they are needed: several numbers
   * that are wanted at the same time travel together, for a reduction costs as
   * much for ten numbers as for one. All processes get the same result, to the
   * last bit, so that decisions based on it are the same everywhere.
   */
  template <std::size_t n>
  std::array<double, n>
  sum_over_processes(const std::array<double, n> &values, const MPI_Comm comm)
  {
    std::array<double, n> result = values;
    if (dealii::Utilities::MPI::n_mpi_processes(comm) > 1)
      {
        count_reduction();
        const WaitingScope waiting;
        MPI_Allreduce(
          values.data(), result.data(), n, MPI_DOUBLE, MPI_SUM, comm);
      }
    return result;
  }

  /** The same for a number of values that is not known in advance. */
  inline void
  sum_over_processes(std::vector<double> &values, const MPI_Comm comm)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(comm) > 1)
      {
        count_reduction();
        const WaitingScope waiting;
        MPI_Allreduce(MPI_IN_PLACE,
                      values.data(),
                      values.size(),
                      MPI_DOUBLE,
                      MPI_SUM,
                      comm);
      }
  }

  inline double
  sum_over_processes(const double value, const MPI_Comm comm)
  {
    return sum_over_processes(std::array<double, 1>{{value}}, comm)[0];
  }

  /** The largest values on any process; none must be NaN. */
  template <std::size_t n>
  std::array<double, n>
  max_over_processes(const std::array<double, n> &values, const MPI_Comm comm)
  {
    std::array<double, n> result = values;
    if (dealii::Utilities::MPI::n_mpi_processes(comm) > 1)
      {
        count_reduction();
        const WaitingScope waiting;
        MPI_Allreduce(
          values.data(), result.data(), n, MPI_DOUBLE, MPI_MAX, comm);
      }
    return result;
  }

  inline void
  max_over_processes(std::vector<double> &values, const MPI_Comm comm)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(comm) > 1)
      {
        count_reduction();
        const WaitingScope waiting;
        MPI_Allreduce(MPI_IN_PLACE,
                      values.data(),
                      values.size(),
                      MPI_DOUBLE,
                      MPI_MAX,
                      comm);
      }
  }

  inline double
  max_over_processes(const double value, const MPI_Comm comm)
  {
    return max_over_processes(std::array<double, 1>{{value}}, comm)[0];
  }

  /** Whether it is true on any process. */
  inline bool
  true_on_any_process(const bool value, const MPI_Comm comm)
  {
    return max_over_processes(value ? 1. : 0., comm) > 0;
  }
} // namespace Friction

#endif
