#pragma once

#include <readerwriterqueue/readerwriterqueue.h>

namespace palp {

/// One writer, one reader, wait-free. Preallocated: on [rt] use try_enqueue and try_dequeue only,
/// which never allocate and answer false when the queue is full or empty.
template <class T>
using SpscQueue = moodycamel::ReaderWriterQueue<T>;

}  // namespace palp
