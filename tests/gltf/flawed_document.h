/// rich_file() with one thing wrong.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <string>

#include "gltf/files.h"

namespace tandem::test {

struct DocumentFlaw {
    const char* name;
    std::function<void(Json&)> make;
    const char* path;      ///< JSON path
    const char* sentence;  ///< a part of it
};

inline void PrintTo(const DocumentFlaw& flaw, std::ostream* out) { *out << flaw.name; }

class FlawedDocument : public GltfFiles, public testing::WithParamInterface<DocumentFlaw> {
  protected:
    static TestFile flawed() {
        TestFile file = rich_file();
        file.json = Json::parse(file.text());  // with its buffer
        GetParam().make(file.json);
        return file;
    }
};

inline std::string flaw_name(const testing::TestParamInfo<DocumentFlaw>& info) { return info.param.name; }

}  // namespace tandem::test
