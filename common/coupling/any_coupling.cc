#include "common/coupling/any_coupling.h"

namespace palp::coupling {
namespace {

tl::unexpected<Error> unknown_name(const std::string& name) {
  std::string text = "unknown coupling '" + name + "'; there are:";
  for (const std::string_view known : kCouplingNames) text.append(" ").append(known);
  return fail(text);
}

}  // namespace

Result<SurgeonCoupling> make_surgeon_coupling(const CouplingConfig& config, const HandFacts& hand) {
  if (config.name == "direct") return SurgeonCoupling{DirectSurgeon{config.direct}};
  if (config.name == "wave") return SurgeonCoupling{WaveSurgeon{config.wave}};
  if (config.name == "tdpa") return SurgeonCoupling{TdpaSurgeon{config.tdpa}};
  if (config.name == "mmt") return SurgeonCoupling{MmtSurgeon{config.mmt, hand}};
  return unknown_name(config.name);
}

Result<PatientCoupling> make_patient_coupling(const CouplingConfig& config,
                                              const PatientDevices& devices) {
  if (config.name == "direct") return PatientCoupling{DirectPatient{config.direct}};
  if (config.name == "wave") return PatientCoupling{WavePatient{config.wave, devices}};
  if (config.name == "tdpa") return PatientCoupling{TdpaPatient{config.tdpa, devices}};
  if (config.name == "mmt") return PatientCoupling{MmtPatient{config.mmt, devices}};
  return unknown_name(config.name);
}

}  // namespace palp::coupling
