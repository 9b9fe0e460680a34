// Text from drivers, files and the command line, made safe for where it is shown.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace edgecase::conformance {

/// Valid UTF-8 without control characters, so that no name can move a terminal's cursor or break an XML file: bytes
/// that are no UTF-8 and code points that XML 1.0 forbids become U+FFFD, and control characters (C0, DEL, C1) become
/// `\x1b` and the like. Line feeds and tabs stay.
std::string visible(std::string_view text);

/// The same on one line: line feeds and tabs become `\n` and `\t`.
std::string visible_line(std::string_view text);

/// visible() with the five characters escaped that mean something to XML and HTML; for text between tags.
std::string markup(std::string_view text);

/// The same for a quoted attribute value, where XML would turn a bare line feed or tab into a space.
std::string markup_attribute(std::string_view text);

/// A relative URL for a file name in the page's own folder, ready for an attribute. It always begins with `./`, and so
/// never names a scheme or another host.
std::string relative_url(std::string_view file_name);

/// Code points of valid UTF-8: the columns it takes on a terminal, if none is wide or combining.
std::size_t columns(std::string_view utf8);

}  // namespace edgecase::conformance
