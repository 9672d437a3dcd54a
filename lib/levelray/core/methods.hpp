// Type lists as the only registries of methods.
//
// A method is a small struct with `static constexpr std::string_view name` (the CLI's word for it), `source`
// (paper, section) and a call operator; a `std::tuple` of them is its family's only list. Names, help texts,
// dispatch, conformance tests and rows of measurements all come from that tuple.
#pragma once

#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace levelray {

// The names of all methods of `List`, in its order.
template <class List>
std::vector<std::string> method_names() {
  return []<std::size_t... I>(std::index_sequence<I...>) {
    return std::vector<std::string>{std::string(std::tuple_element_t<I, List>::name)...};
  }
  (std::make_index_sequence<std::tuple_size_v<List>>());
}

// Calls visit(Method{}) for the method called `name`; returns false, without a call, when there is none.
template <class List, class Visit>
bool visit_method(std::string_view name, Visit&& visit) {
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return ((std::tuple_element_t<I, List>::name == name ? (visit(std::tuple_element_t<I, List>{}), true)
                                                         : false) ||
            ...);
  }
  (std::make_index_sequence<std::tuple_size_v<List>>());
}

} // namespace levelray
