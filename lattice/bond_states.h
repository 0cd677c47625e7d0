#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/triangular_lattice.h"
#include "lattice/zero_pages.h"

namespace latcon::lattice
{

/// Bonds that are present and bonds that are toughened, two bits per bond: one word for six of the bonds that start at
/// a place, with the present kinds in the lower byte and the toughened kinds in the upper one. The words of the third-
/// nearest neighbours are stored apart, and only if there are any.
class BondStates
{
public:
  using Word = std::uint16_t;
  using Words = std::vector<Word, ZeroPages<Word>>;
  static constexpr std::size_t kinds_per_word = 2 * n_kinds_per_shell;

  /// No bonds at all at n places. @param has_third_nearest whether bonds of the third shell may be added
  void clear(std::size_t n, bool has_third_nearest = false) { words_ = {Words(n), Words(has_third_nearest ? n : 0)}; }
  /// Kinds of bonds that may be there: the first so many.
  std::size_t n_kinds() const { return words_[1].empty() ? kinds_per_word : n_bond_kinds; }

  bool present(std::size_t place, std::size_t kind) const { return has(place, kind, bit(kind)); }
  bool toughened(std::size_t place, std::size_t kind) const { return has(place, kind, toughened_bit(kind)); }

  /// Makes a bond of one of these kinds present, and not toughened.
  void add(std::size_t place, std::size_t kind)
  {
    remove(place, kind);
    Word &word = words_[kind / kinds_per_word][place];
    word = static_cast<Word>(word | bit(kind));
  }
  void remove(std::size_t place, std::size_t kind)
  {
    if (kind >= n_kinds())
      return;
    Word &word = words_[kind / kinds_per_word][place];
    word = static_cast<Word>(word & ~(bit(kind) | toughened_bit(kind)));
  }
  /// Toughens a bond that is present.
  void toughen(std::size_t place, std::size_t kind)
  {
    Word &word = words_[kind / kinds_per_word][place];
    word = static_cast<Word>(word | toughened_bit(kind));
  }

  /// The words that hold a kind of bonds, one a place; nullptr for kinds of n_kinds() on.
  const Word *words(std::size_t kind = 0) const
  {
    return kind < n_kinds() ? words_[kind / kinds_per_word].data() : nullptr;
  }
  /// Of the first two shells, and of the third: for other ranks and for files to fill.
  std::array<Words, 2> &storage() { return words_; }
  static constexpr Word bit(std::size_t kind) { return static_cast<Word>(1u << kind % kinds_per_word); }
  static constexpr Word toughened_bit(std::size_t kind) { return static_cast<Word>(0x100u << kind % kinds_per_word); }

private:
  bool has(std::size_t place, std::size_t kind, Word mask) const
  {
    return kind < n_kinds() && (words_[kind / kinds_per_word][place] & mask) != 0;
  }

  std::array<Words, 2> words_;
};

} // namespace latcon::lattice
