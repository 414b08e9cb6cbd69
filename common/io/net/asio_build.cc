// Boost.Asio's own implementation, compiled once: the other sources of this room see declarations.
#include <boost/asio/impl/src.hpp>
