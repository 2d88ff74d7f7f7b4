#include <common/parallel/collective_error.h>
#include <common/printable.h>

namespace Friction
{
  void
  throw_if_any(const MPI_Comm                    communicator,
               const std::optional<std::string> &sentence)
  {
    using namespace dealii;
    const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);
    const unsigned int none = Utilities::MPI::n_mpi_processes(communicator);
    const unsigned int first =
      Utilities::MPI::min(sentence ? rank : none, communicator);
    if (first == none)
      return;
    throw InputError(Utilities::MPI::broadcast(
      communicator, sentence.value_or(std::string()), first));
  }



  void
  throw_or_abort(const MPI_Comm communicator, const std::string &sentence)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(communicator) > 1)
      {
        print_error("Error: " + printable(sentence));
        MPI_Abort(communicator, 2);
      }
    throw InputError(sentence);
  }
} // namespace Friction
