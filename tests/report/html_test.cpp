#include "tandem/report/html_text.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace tandem {
namespace {

TEST(HtmlText, EscapesEverythingThatHasAMeaning) {
    EXPECT_EQ(escape_html("a<b> & \"c\" 'd'"), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
    EXPECT_EQ(escape_html("µ ≥ 95 %"), "µ ≥ 95 %");
    EXPECT_EQ(escape_html(std::string_view("\x01\n\x7f", 3)), "\uFFFD\n\uFFFD");
}

TEST(HtmlText, Base64OfTheStandardsExamples) {
    // RFC 4648, section 10.
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64(std::string_view("\xff\x00\xfe", 3)), "/wD+");
}

TEST(HtmlText, TemplatesAreFilledOnce) {
    EXPECT_EQ(fill_template("<{{a}}>{{b}}{{a}}", {{"a", "{{b}}"}, {"b", "x"}}), "<{{b}}>x{{b}}");
    EXPECT_EQ(fill_template("nothing", {}), "nothing");
    EXPECT_THROW((void)fill_template("{{missing}}", {}), std::logic_error);
    EXPECT_THROW((void)fill_template("{{open", {}), std::logic_error);
}

}  // namespace
}  // namespace tandem
