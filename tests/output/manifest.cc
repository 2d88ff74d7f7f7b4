// What a manifest finds: everything that is not as it was written, and nothing
// else.

#include <common/output/manifest.h>
#include <tests/support/check.h>
#include <tests/support/random.h>
#include <tests/support/test.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <sstream>
#include <string>

using namespace Friction;
namespace fs = std::filesystem;

namespace test_manifest
{
  const fs::path directory = "manifest-test";



  std::string
  read(const fs::path &file)
  {
    std::ifstream      in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }



  void
  write(const fs::path &file, const std::string &text)
  {
    std::ofstream(file, std::ios::binary) << text;
  }



  std::string
  fault()
  {
    return Manifest::fault(directory.string(), 3);
  }



  // A change of a file that is then taken back.
  void
  try_to(const std::string           &what,
         const std::string           &name,
         const std::function<void()> &change)
  {
    const bool        existed = fs::exists(directory / name);
    const std::string text    = read(directory / name);
    change();
    std::cout << what << ": " << fault() << std::endl;
    fs::remove_all(directory / name);
    if (existed)
      write(directory / name, text);
  }
} // namespace test_manifest

TEST(manifest)
{
  // The value that lists of such checks give for this text.
  std::istringstream digits("123456789");
  Tests::check(Manifest::checksum(digits) == 0x995dc9bbdf1939faull,
               "checksum of a known text");
  // More than is read at once, and a multiple of that.
  std::istringstream long_text(std::string(1 << 17, 'a') + "b");
  std::istringstream other_text(std::string(1 << 17, 'a') + "c");
  Tests::check(Manifest::checksum(long_text) != Manifest::checksum(other_text),
               "checksums of long texts");

  fs::remove_all(directory);
  fs::create_directory(directory);
  write(directory / "mesh", std::string(100000, 'm') + '\0');
  write(directory / "mesh.info", "a few numbers\n");
  write(directory / "empty", "");
  Manifest::write(directory.string(), 3);
  std::cout << read(directory / "manifest");
  std::cout << "as it was written: '" << fault() << "'" << std::endl;
  std::cout << "another level: " << Manifest::fault(directory.string(), 4)
            << std::endl;

  const auto file = [](const std::string &name) { return directory / name; };
  for (const std::string name : {"mesh", "empty", "manifest"})
    {
      try_to(name + " removed", name, [&]() { fs::remove(file(name)); });
      try_to(name + " longer", name, [&]() {
        write(file(name), read(file(name)) + "more");
      });
    }
  for (const std::string name : {"mesh", "manifest"})
    try_to(name + " empty", name, [&]() { write(file(name), ""); });
  try_to("a folder in place of a file", "mesh", [&]() {
    fs::remove(file("mesh"));
    fs::create_directory(file("mesh"));
  });
  try_to("one more file", "more", [&]() { write(file("more"), ""); });
  try_to("a very long manifest", "manifest", [&]() {
    write(file("manifest"), std::string(100000, 'x'));
  });
  try_to("a manifest of a later version", "manifest", [&]() {
    // With the right checksum of its lines.
    const std::string  lines = "checkpoint, format 3\nlevel 3\n";
    std::istringstream in(lines);
    std::ostringstream last;
    last << std::hex << Manifest::checksum(in);
    write(file("manifest"),
          lines + "checksum of these lines " +
            std::string(16 - last.str().size(), '0') + last.str() + '\n');
  });

  // Every bit of the manifest, and many of the other files.
  Tests::Random                       random(1);
  std::map<std::string, unsigned int> tried, found;
  for (const std::string name : {"manifest", "mesh.info", "mesh"})
    {
      const std::string text = read(file(name));
      const std::size_t n    = 8 * text.size();
      for (std::size_t i = 0; i < std::min<std::size_t>(n, 4000); ++i)
        {
          const std::size_t bit     = (n <= 4000 ? i : random.below(n));
          std::string       damaged = text;
          damaged[bit / 8]          = damaged[bit / 8] ^ (1 << bit % 8);
          write(file(name), damaged);
          const std::string sentence = fault();
          ++tried[name];
          found[name] += (sentence.find("'" + name + "'") != sentence.npos);
        }
      write(file(name), text);
      Tests::check(tried[name] > 100 && found[name] == tried[name],
                   "all flipped bits of " + name + " are found");
    }
  for (const std::string name : {"manifest", "mesh.info"})
    {
      const std::string text = read(file(name));
      bool              all  = true;
      for (std::size_t n = 0; n < text.size(); ++n)
        {
          write(file(name), text.substr(0, n));
          all = all && !fault().empty();
        }
      write(file(name), text);
      Tests::check(all, "all ends that " + name + " may lose are missed");
    }
  std::cout << "as it was written: '" << fault() << "'" << std::endl;
}
