#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/result.h"
#include "server/http/http_message.h"

// Parts of long answers [RFC 9110, 14], so that GIS tools open a raster or a GeoPackage in place.
namespace slipway::server {

// The bytes from `first` to `last`, both of which belong to it.
struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};
struct WholeBody {};
struct UnsatisfiableRange {};
using AskedBytes = std::variant<WholeBody, ByteRange, UnsatisfiableRange>;

// Which bytes the request asks for of a body of that many under this tag: one range of `Range: bytes=...`
// where the method is GET and `If-Range`, if there is one, names the tag. The whole where there are several
// ranges, which would have to be put together, and where the header can't be read, as the RFC allows.
AskedBytes asked_bytes(const HttpRequest& request, std::string_view tag, std::uint64_t size);

// A body that lies in pages, each of which can be read by itself. The tag is that of its bytes.
struct PagedBody {
  std::vector<std::uint64_t> page_bytes;
  std::function<Result<std::string>(std::size_t page)> read;  // pages are numbered from 0
  std::string tag;
};

// The answer with what the request asks for of the body, read page by page while it is sent: 200 with the
// whole, 206 with a part, 304 where the client has it already, 416 where no byte is in the range.
HttpResponse ranged(HttpResponse answer, PagedBody body, const HttpRequest& request);

}  // namespace slipway::server
