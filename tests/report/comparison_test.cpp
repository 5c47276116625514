// The comparison of pictures: what is on the page, and what its script does in a browser.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

#include "support/temporary_folder.h"
#include "tandem/base/whole_file.h"
#include "tandem/images/image_codecs.h"
#include "tandem/report/html_writer.h"

namespace tandem {
namespace {

Picture picture(const std::string& caption, std::uint8_t level) {
    ByteImage image{8, 6, {}};
    image.values.assign(std::size_t{3} * 8 * 6, level);
    const Bytes png = encode_png(image, {}, 1);
    return {caption, {reinterpret_cast<const char*>(png.data()), png.size()}};
}

Report compared() {
    Report report;
    report.title = "Compared";
    PictureComparison comparison{"At equal time", {}};
    for (const char* name : {"noisy <cpu>", "clean", "third"}) {
        comparison.pictures.push_back({picture(name, 40), picture(std::string("map of ") + name, 200)});
    }
    report.blocks.emplace_back(comparison);
    return report;
}

TEST(PictureComparison, ShowsEveryPictureWithoutAScript) {
    const std::string html = to_html(compared());
    for (const char* part : {"noisy &lt;cpu&gt;", "map of clean", "<figure class=\"compare\">", "<script>"}) {
        EXPECT_NE(html.find(part), std::string::npos) << part;
    }
    std::size_t images = 0;
    for (std::size_t at = html.find("<img"); at != std::string::npos; at = html.find("<img", at + 1)) ++images;
    EXPECT_EQ(images, 6U);
    for (const char* outside : {"http:", "https:", " src=\"/", "<link", "@import", "{{", "}}"}) {
        EXPECT_EQ(html.find(outside), std::string::npos) << outside;
    }
}

/// What a browser makes of a page after its scripts have run. Standard error is dropped.
std::string rendered(const std::string& html) {
    const test::TemporaryFolder folder;
    const std::string page = folder.file("page.html");
    write_file(page, html, Durability::written);
    const std::string command = std::string(TANDEM_BROWSER) +
                                " --headless --no-sandbox --disable-gpu --user-data-dir=" + folder.file("profile") +
                                " --virtual-time-budget=5000 --dump-dom file://" + page + " 2>/dev/null";
    std::FILE* pipe = popen(command.c_str(), "r");
    std::string text;
    std::array<char, 4096> part{};
    while (pipe != nullptr && std::fgets(part.data(), part.size(), pipe) != nullptr) text += part.data();
    if (pipe != nullptr) pclose(pipe);
    return text;
}

TEST(PictureComparison, DividesZoomsAndShowsMapsInABrowser) {
    if (std::string(TANDEM_BROWSER).empty()) GTEST_SKIP() << "no browser of the Chromium family";
    std::string html = to_html(compared());
    // A reader who moves the divider, zooms, chooses the third picture and asks for maps
    const std::string reader = R"(<script>
const figure = document.querySelector(".compare"), one = (name) => figure.querySelector(name);
const use = (control, change) => { Object.assign(control, change); control.dispatchEvent(new Event("input")); };
const said = [];
const say = () => said.push([one(".left").alt, one(".right").alt, one(".layers").style.width,
                             one(".right").style.clipPath, one(":scope > figcaption:last-of-type").textContent].join("|"));
say();
use(one(".split"), { value: 250 }); say();
use(one(".zoom"), { value: 4 }); say();
use(one("select"), { selectedIndex: 2 }); use(one(".maps"), { checked: true }); say();
said.push("grid " + getComputedStyle(one(".pictures")).display);
document.body.append(Object.assign(document.createElement("pre"), { id: "said", textContent: said.join("\n") }));
</script></body>)";
    const std::size_t end = html.rfind("</body>");
    ASSERT_NE(end, std::string::npos);
    html.replace(end, 7, reader);
    const std::string page = rendered(html);
    const std::size_t start = page.find("<pre id=\"said\">");
    ASSERT_NE(start, std::string::npos) << page.substr(0, 2000);
    const std::string said = page.substr(start);
    EXPECT_NE(said.find("noisy &lt;cpu&gt;|clean|100%|inset(0px 0px 0px 50%)"), std::string::npos) << said;
    EXPECT_NE(said.find("|100%|inset(0px 0px 0px 25%)"), std::string::npos) << said;
    EXPECT_NE(said.find("|400%|"), std::string::npos) << said;
    EXPECT_NE(said.find("map of third|map of clean|400%"), std::string::npos) << said;
    EXPECT_NE(said.find("Left of the divider: map of third."), std::string::npos) << said;
    EXPECT_NE(said.find("grid none"), std::string::npos) << said;
}

}  // namespace
}  // namespace tandem
