#ifndef friction_parallel_reductions_h
#define friction_parallel_reductions_h

#include <common/parallel/phase_costs.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <type_traits>
#include <vector>

namespace Friction
{
  /**
   * Replaces @p n values by what MPI's operation @p operation makes of those of
   * all processes. Several numbers that are wanted at the same time travel
   * together, for a reduction costs as much for ten numbers as for one. All
   * processes get the same result, to the last bit, so that decisions based on
   * it are the same everywhere. None of the values must be NaN.
   */
  inline void
  reduce_over_processes(double        *values,
                        const int      n,
                        const MPI_Op   operation,
                        const MPI_Comm comm)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(comm) == 1)
      return;
    count_reduction(comm);
    const WaitingScope waiting(comm);
    MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_DOUBLE, operation, comm);
  }

  /** The sums over all processes. */
  template <std::size_t n>
  std::array<double, n>
  sum_over_processes(std::array<double, n> values, const MPI_Comm comm)
  {
    reduce_over_processes(values.data(), n, MPI_SUM, comm);
    return values;
  }

  inline void
  sum_over_processes(std::vector<double> &values, const MPI_Comm comm)
  {
    reduce_over_processes(values.data(), values.size(), MPI_SUM, comm);
  }

  inline double
  sum_over_processes(double value, const MPI_Comm comm)
  {
    reduce_over_processes(&value, 1, MPI_SUM, comm);
    return value;
  }

  /** The largest values on any process. */
  template <std::size_t n>
  std::array<double, n>
  max_over_processes(std::array<double, n> values, const MPI_Comm comm)
  {
    reduce_over_processes(values.data(), n, MPI_MAX, comm);
    return values;
  }

  inline void
  max_over_processes(std::vector<double> &values, const MPI_Comm comm)
  {
    reduce_over_processes(values.data(), values.size(), MPI_MAX, comm);
  }

  inline double
  max_over_processes(double value, const MPI_Comm comm)
  {
    reduce_over_processes(&value, 1, MPI_MAX, comm);
    return value;
  }

  /** The bytes of all processes, in the order of their ranks. */
  std::vector<char>
  gather_bytes_from_all(const char *own, std::size_t size, const MPI_Comm comm);

  /** What all processes have, on all of them, in the order of their ranks.
   * Utilities::MPI::all_gather() can send whatever can be packed, which takes a
   * compiler seconds for each type; here it is what can be copied as bytes. */
  template <typename Value>
  std::vector<Value>
  gather_from_all(const std::vector<Value> &own, const MPI_Comm comm)
  {
    static_assert(std::is_trivially_copyable<Value>::value,
                  "Only what can be copied as bytes can be gathered.");
    if (dealii::Utilities::MPI::n_mpi_processes(comm) == 1)
      return own;
    const std::vector<char> bytes =
      gather_bytes_from_all(reinterpret_cast<const char *>(own.data()),
                            own.size() * sizeof(Value),
                            comm);
    const Value *const first = reinterpret_cast<const Value *>(bytes.data());
    return {first, first + bytes.size() / sizeof(Value)};
  }

  /** Whether it is true on any process. */
  inline bool
  true_on_any_process(const bool value, const MPI_Comm comm)
  {
    return max_over_processes(value ? 1. : 0., comm) > 0;
  }
} // namespace Friction

#endif
