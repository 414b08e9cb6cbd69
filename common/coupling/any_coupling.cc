#include "common/coupling/any_coupling.h"

namespace palp::coupling {
namespace {

tl::unexpected<Error> unknown_name(const std::string& name) {
  std::string text = "unknown coupling '" + name + "'; there are:";
  for (const std::string_view known : kCouplingNames) text.append(" ").append(known);
  return fail(text);
}

}  // namespace

Result<SurgeonCoupling> make_surgeon_coupling(const CouplingConfig& config) {
  if (config.name == "direct") return SurgeonCoupling{DirectSurgeon{config.direct}};
  return unknown_name(config.name);
}

Result<PatientCoupling> make_patient_coupling(const CouplingConfig& config) {
  if (config.name == "direct") return PatientCoupling{DirectPatient{config.direct}};
  return unknown_name(config.name);
}

}  // namespace palp::coupling
