#include "review/check.h"

#include "common/record/session_reader.h"
#include "review/lack.h"

namespace palp::review {

Checked checked(const record::FileBytes& file) {
  record::SessionReader reader{file};
  while (reader.next()) {
  }
  Checked found{.fault = fault_of(reader), .lack = {}};
  if (!found.fault) found.lack = lack_of(reader);
  return found;
}

}  // namespace palp::review
