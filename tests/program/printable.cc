// What is printed of what a user gave us: one line without anything that a
// terminal would obey, and not more than a line of it.

#include <common/printable.h>
#include <tests/support/check.h>
#include <tests/support/test.h>

#include <iostream>

using namespace Friction;

namespace test_printable
{
  std::string
  times(const unsigned int n, const std::string &text)
  {
    std::string result;
    for (unsigned int i = 0; i < n; ++i)
      result += text;
    return result;
  }
} // namespace test_printable

TEST(printable)
{
  for (const std::string text :
       {"plain text, with 'quotes' and a back\\slash",
        "one line\nand another\ttab",
        "colours \x1b[31m, a bell \a, delete \x7f",
        "Gr\xc3\xb6\xc3\x9f"
        "e, \xe2\x82\xac, \xf0\x9f\x98\x80",
        "no UTF-8: \xff \xc3 \xe2\x82 \xf0\x9f\x98",
        "longer than needed: \xc0\xaf \xe0\x80\xaf \xf0\x80\x80\xaf",
        "no characters: \xed\xa0\x80 \xf4\x90\x80\x80",
        "control characters: \xc2\x9b \xc2\x85",
        "from right to left: \xe2\x80\xae, no width: \xe2\x80\x8b "
        "\xef\xbb\xbf"})
    std::cout << printable(text) << std::endl;
  std::cout << printable(std::string("zero \0 byte", 11)) << std::endl;

  std::cout << excerpt("short") << std::endl
            << excerpt(times(60, "x")) << std::endl
            << excerpt(times(60, "x") + "y") << std::endl
            << excerpt("begin " + times(10000000, "x") + " end") << std::endl
            << excerpt(times(61, "\xc3\xb6")) << std::endl
            << excerpt("begin " + times(10000, "\xf0\x9f\x98\x80") + " end")
            << std::endl
            << excerpt(times(15, "\x01")) << std::endl
            << excerpt(times(100, "\x01")) << std::endl
            << excerpt(times(100, "abc"), 10) << std::endl
            << "'" << excerpt("") << "'" << std::endl;

  // All bytes, alone and in pairs, whatever they are.
  bool all = true;
  for (unsigned int a = 0; a < 256; ++a)
    for (unsigned int b = 0; b < 256; ++b)
      for (const std::string &text :
           {printable({static_cast<char>(a), static_cast<char>(b)}),
            excerpt(times(70, {static_cast<char>(a), static_cast<char>(b)}))})
        for (std::size_t i = 0; i < text.size();)
          {
            const std::size_t n = printable_bytes(text, i);
            all                 = all && n > 0;
            i += (n > 0 ? n : 1);
          }
  Tests::check(all, "nothing unprintable is left of any two bytes");
}
