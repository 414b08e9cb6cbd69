// Goal: no list forgets a member. Method: a struct of all ones without its padding shows which
// bytes are of members; each must lie in something that the list reaches.
#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <typeinfo>
#include <vector>

#include <gtest/gtest.h>

#include "common/message/kind.h"
#include "common/message/warm_up_telegrams.h"
#include "tests/common/message/all_structs.h"
#include "tests/common/message/same.h"

namespace palp::message {

/// A struct whose list leaves one out.
struct Forgetful {
  std::uint32_t told{};
  double forgotten{};  ///< [-]
};
template <std::same_as<Forgetful> S>
inline constexpr auto fields<S> = list({}, field<1, &S::told>("told"));

namespace {

/// For each byte whether it is of a member. Variants and optionals count as one whole.
template <class Struct>
std::vector<bool> member_bytes() {
  alignas(Struct) std::byte room[sizeof(Struct)];
  auto* object = new (room) Struct;
  std::memset(room, 0xFF, sizeof room);
  __builtin_clear_padding(object);
  std::vector<bool> used(sizeof room);
  for (std::size_t i = 0; i < sizeof room; ++i) used[i] = room[i] != std::byte{0};
  return used;
}

template <class Struct>
void mark_reached(const Struct& object, const std::byte* base, std::vector<bool>& reached);

void mark(const auto& value, const std::byte* base, std::vector<bool>& reached) {
  using Value = std::remove_cvref_t<decltype(value)>;
  if constexpr (Described<Value>) {
    mark_reached(value, base, reached);
  } else {
    const auto* begin = reinterpret_cast<const std::byte*>(std::addressof(value));
    for (std::size_t i = 0; i < sizeof value; ++i) {
      reached[static_cast<std::size_t>(begin - base) + i] = true;
    }
  }
}

template <class Struct>
void mark_reached(const Struct& object, const std::byte* base, std::vector<bool>& reached) {
  each(fields<Struct>.items,
       [&]<class Item>(const Item& /*item*/) { mark(Item::of(object), base, reached); });
}

TEST(ListTest, EachMemberOfEachStructIsInItsList) {
  each_struct([]<class Struct>() {
    const Struct object{};
    std::vector<bool> reached(sizeof(Struct));
    mark_reached(object, reinterpret_cast<const std::byte*>(&object), reached);
    const std::vector<bool> used = member_bytes<Struct>();
    for (std::size_t i = 0; i < used.size(); ++i) {
      EXPECT_TRUE(!used[i] || reached[i]) << typeid(Struct).name() << ", byte " << i;
    }
  });
}

TEST(ListTest, AMemberThatIsInNoListIsSeen) {
  const Forgetful object{};
  std::vector<bool> reached(sizeof object);
  mark_reached(object, reinterpret_cast<const std::byte*>(&object), reached);
  const std::vector<bool> used = member_bytes<Forgetful>();
  EXPECT_TRUE(used[offsetof(Forgetful, forgotten)]);
  EXPECT_FALSE(reached[offsetof(Forgetful, forgotten)]);
  EXPECT_TRUE(reached[offsetof(Forgetful, told)]);
}

TEST(ListTest, EnumerationsHaveAsManyNamesAsEnumerators) {
  EXPECT_EQ(enumerators<SiteState>.values.size(), std::size_t{kSiteStateCount});
  EXPECT_EQ(enumerators<LinkState>.values.size(), std::size_t{kLinkStateCount});
  EXPECT_EQ(enumerators<DepthVerdict>.values.size(), std::size_t{kDepthVerdictCount});
  EXPECT_EQ(enumerators<DepthReason>.values.size(), std::size_t{kDepthReasonCount});
}

TEST(WarmUpTelegramsTest, NothingInAnyOfThemIsZero) {
  std::size_t kind = 0;
  for (const Telegram& telegram : warm_up_telegrams()) {
    EXPECT_EQ(telegram.port.payload.index(), kind++);
    for (const Words& words : {words_of(telegram.site), words_of(telegram.port)}) {
      for (std::size_t i = 0; i < words.size(); ++i) {
        const bool is_kind = kind == 1 && words.size() == 4 && i == 3;  // 0: no payload
        EXPECT_TRUE(words[i] != 0 || is_kind) << kind << ", number " << i;
      }
    }
  }
}

}  // namespace
}  // namespace palp::message
