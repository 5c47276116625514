#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tandem/report/csv_writer.h"
#include "tandem/report/html_writer.h"
#include "tandem/report/json_writer.h"
#include "tandem/report/text_writer.h"

namespace tandem {
namespace {

BenchmarkRow example_row() {
    BenchmarkRow row;
    row.label = "CPU, \"all\" threads";
    row.scene = "named:paper";
    row.backend = "cpu";
    row.variant = "x86-64-v3, loop";
    row.tier = "strict";
    row.threads = 16;
    row.seconds = {0.2, 0.1, 0.3};
    row.rounds = {0, 1, 2};
    row.samples = 9e7;
    row.factor = Factor{"slow", {100, Interval{90, 110}, 3}};
    row.errors.push_back({"oracle", "any bit", 0});
    row.effects = Effect::shadows | Effect::lens;
    row.figures = {{"mean FLIP", 0.25}};
    row.series = {{"RMSE", {0.1, 0.2, 0.3}}};
    phase(row, "render").seconds = {0.1, 0.05, 0.2};
    return row;
}

Report example_report() {
    Report report;
    report.title = "A <title> & more";
    report.summary = "What it shows.";
    report.command = "tandem-bench paper --out 'a b'";
    report.machine = describe_machine();
    report.rows = {example_row()};
    report.properties = {{"hash", "0123"}};
    report.blocks.emplace_back(Heading{"First"});
    report.blocks.emplace_back(Paragraph{"Prose with <angle> brackets."});
    report.blocks.emplace_back(Callout{Callout::Kind::bad, "a target was missed"});
    report.blocks.emplace_back(Table{"Caption", {{"Name"}, {"Value", true}}, {{"µ", "1"}, {"wide cell", "22"}}});
    LinePlot plot{"Frames", {"frame"}, {"ms"}, {}, {}};
    plot.lines.push_back({"CPU", {{0, 1}, {1, std::numeric_limits<double>::quiet_NaN()}}});
    report.blocks.emplace_back(plot);
    report.blocks.emplace_back(PictureGrid{{{"Frame 0", "\x89PNG"}}});
    ScatterPlot scatter{"Error", {"s", true}, {"RMSE", true}, {"samples", "tier"}, {}, {}};
    scatter.series.push_back({"cpu", {{{1, 2}, {0.5, 1.5}, {1, 3}, "cpu, fast", "3", 1, true, false}}});
    report.blocks.emplace_back(scatter);
    return report;
}

TEST(JsonWriter, HoldsEveryMeasurementAndTheMachine) {
    const auto json = nlohmann::json::parse(to_json(example_report()));
    EXPECT_EQ(json["title"], "A <title> & more");
    EXPECT_EQ(json["properties"]["hash"], "0123");
    const auto& row = json["rows"][0];
    EXPECT_EQ(row["seconds"], (std::vector<double>{0.2, 0.1, 0.3}));
    EXPECT_EQ(row["summary"]["median"], 0.2);
    EXPECT_EQ(row["samples_per_second"], 4.5e8);
    EXPECT_EQ(row["factor"]["interval_95"][1], 110);
    EXPECT_EQ(row["phases"]["render"]["summary"]["median"], 0.1);
    EXPECT_EQ(row["errors"][0]["share"], 0);
    EXPECT_EQ(row["effects"], "shadows, lens");
    EXPECT_EQ(row["carried"], "none");
    EXPECT_EQ(row["figures"]["mean FLIP"], 0.25);
    EXPECT_EQ(row["series"]["RMSE"][2], 0.3);
    EXPECT_TRUE(row["summary"]["interval_95"].is_null()) << "three measurements are too few";
    EXPECT_EQ(json["machine"]["compiler"], example_report().machine.compiler);
    EXPECT_EQ(json["callouts"][0]["kind"], "bad");
    EXPECT_EQ(json["tables"][0]["rows"][1][1], "22");
    EXPECT_TRUE(json["plots"][0]["lines"][0]["points"][1][1].is_null()) << "NaN becomes null";
    const auto& point = json["plots"][1]["series"][0]["points"][0];
    EXPECT_EQ(point["label"], "cpu, fast");
    EXPECT_EQ(point["shape"], "tier");
    EXPECT_EQ(point["y_interval_95"][1], 3);
    EXPECT_EQ(point["faded"], true);
}

TEST(JsonWriter, SurvivesTextThatIsNotUtf8) {
    Report report = example_report();
    report.machine.more.emplace_back("device", "broken \xff name");
    EXPECT_TRUE(nlohmann::json::accept(to_json(report)));
}

TEST(CsvWriter, QuotesAndKeepsOneLinePerRow) {
    const std::vector<BenchmarkRow> rows = {example_row(), BenchmarkRow{}};
    const std::string csv = to_csv(rows);
    EXPECT_NE(csv.find("\"CPU, \"\"all\"\" threads\",named:paper,cpu,"), std::string::npos) << csv;
    std::istringstream text(csv);
    std::string header, line;
    ASSERT_TRUE(std::getline(text, header));
    EXPECT_NE(header.find(",render_seconds,render_seconds_low,render_seconds_high"), std::string::npos);
    EXPECT_NE(header.find(",mean FLIP"), std::string::npos);
    EXPECT_NE(csv.find(",0.25\r\n"), std::string::npos) << csv;
    int lines = 0;
    while (std::getline(text, line)) ++lines;
    EXPECT_EQ(lines, 2);
}

TEST(TextWriter, AlignsColumnsOfCharactersNotBytes) {
    const std::string text = to_text(example_report());
    EXPECT_NE(text.find("Name       Value\n---------  -----\nµ              1\nwide cell     22\n"), std::string::npos)
        << text;
    EXPECT_NE(text.find("NOT OK: a target was missed\n"), std::string::npos);
}

TEST(HtmlWriter, NeedsNothingButItself) {
    const std::string html = to_html(example_report());
    EXPECT_NE(html.find("<title>A &lt;title&gt; &amp; more</title>"), std::string::npos);
    EXPECT_NE(html.find("&lt;angle&gt;"), std::string::npos);
    EXPECT_EQ(html.find("<angle>"), std::string::npos);
    EXPECT_NE(html.find("src=\"data:image/png;base64,iVBORw==\""), std::string::npos);
    EXPECT_NE(html.find("<svg"), std::string::npos);
    EXPECT_NE(html.find("CPU, &quot;all&quot; threads"), std::string::npos);
    for (const char* outside : {"http:", "https:", "<script", "<link", "@import", "url(", "{{", "}}"}) {
        EXPECT_EQ(html.find(outside), std::string::npos) << outside;
    }
}

}  // namespace
}  // namespace tandem
