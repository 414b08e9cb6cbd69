#pragma once

#include <string>
#include <vector>

#include "study/data_set.h"

/// Participants who do not want their answers kept: code/withdrawn.txt, an identifier a line, which
/// only grows. Errors are CannotOpen.
namespace palp::study {

/// Nobody where there is no list; one that cannot be read is an error.
[[nodiscard]] Result<std::vector<std::string>> withdrawn_participants(const DataSet& data);
[[nodiscard]] Result<bool> has_withdrawn(const DataSet& data, const std::string& id);
/// No failure makes the list shorter.
[[nodiscard]] Result<void> add_withdrawn(const DataSet& data, const std::string& id);

/// Answers and traces of a participant go.
[[nodiscard]] Result<void> delete_participant(const DataSet& data, const std::string& id);
/// Those on the list of whom answers or traces are still there.
[[nodiscard]] Result<std::vector<std::string>> withdrawn_with_data(const DataSet& data);
/// Files below the folder that hold the identifier, but for the list itself; of session files the
/// names count alone.
[[nodiscard]] Result<std::vector<std::string>> files_with(const DataSet& data,
                                                          const std::string& id);

}  // namespace palp::study
