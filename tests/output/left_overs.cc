// Which files a run takes for those of earlier runs, by their names, and that
// it removes these and nothing else; what cannot be removed is said to be
// there.

#include <common/output/left_overs.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>

#include <tests/support/test.h>

using namespace Friction;
namespace fs = std::filesystem;

namespace
{
  // Files whose names have this in them cannot be removed; nothing is in all.
  const char *protected_part = "";
} // namespace



// This one takes the place of the function of the system, for all libraries.
extern "C" int
remove(const char *name) noexcept
{
  if (*protected_part != '\0' && std::strstr(name, protected_part) != nullptr)
    {
      errno = EACCES;
      return -1;
    }
  return unlink(name) == 0 || rmdir(name) == 0 ? 0 : -1;
}



TEST(left_overs)
{
  const std::set<std::string> names = {// Ours.
                                       "body.pvd",
                                       "contact.pvd",
                                       "body.xdmf",
                                       "body-00.pvtu",
                                       "contact-12.pvtu",
                                       "body-123.pvtu",
                                       "body-12.pvtu",
                                       "body-05.0000.vtu",
                                       "contact-05.12345.vtu",
                                       "body-07.h5",
                                       "verify-07.h5",
                                       "body.part.pvd",
                                       "body.part.xdmf",
                                       "body-00.part.pvtu",
                                       "body-05.0000.part.vtu",
                                       "body-07.part.h5",
                                       "history.part.h5",
                                       ".writable-12-3",
                                       // Replaced, but never removed.
                                       "history.h5",
                                       ".lock",
                                       // Not ours.
                                       "body",
                                       "body-5.pvtu",
                                       "body-005.pvtu",
                                       "body-1234567.pvtu",
                                       "body-05.vtu",
                                       "body-05.000.vtu",
                                       "body-05.0000.vtu.part",
                                       "body-05.0000.vtk",
                                       "contact.xdmf",
                                       "contact-05.h5",
                                       "verify-05.pvtu",
                                       "verify.h5",
                                       "my-body.pvd",
                                       "body.pvd~",
                                       "body.part.part.pvd",
                                       "History.part.h5",
                                       ".writable-12",
                                       "body-0x.pvtu",
                                       "notes.txt"};

  std::cout << std::boolalpha;
  for (const std::string &name : names)
    {
      std::cout << "'" << name << "': ";
      if (const auto file = run_file(name))
        std::cout << "'" << file->what << "', level " << file->level << ", '"
                  << file->ending << "'"
                  << (file->unfinished ? ", unfinished" : "") << std::endl;
      else
        std::cout << "nothing" << std::endl;
    }

  fs::remove_all("left-overs-test");
  const RunDirectory directory("left-overs-test");
  for (const std::string &name : names)
    std::ofstream(directory.file(name)) << name;
  fs::create_directory(directory.file("body-44.pvtu"));
  std::ofstream(directory.file("body-44.pvtu/text")) << "mine";

  const auto list = [&]() {
    std::set<std::string> found;
    for (const auto &entry : fs::directory_iterator(directory.path()))
      found.insert(entry.path().filename().string());
    for (const std::string &name : found)
      std::cout << "  " << name << std::endl;
  };
  const auto high = [](const RunFile &file) { return file.level >= 12; };
  for (const char *part : {"-1", "body-12."})
    {
      protected_part = part;
      std::cout << "warning: '" << remove_left_overs(directory, high) << "'"
                << std::endl;
    }
  protected_part = "";
  std::cout << "warning: '" << remove_left_overs(directory, high) << "'"
            << std::endl;
  list();
  std::cout << "warning: '"
            << remove_left_overs(directory,
                                 [](const RunFile &) { return true; })
            << "'" << std::endl;
  list();
}
