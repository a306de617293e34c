#pragma once

#include "core/message_text.h"

namespace retrace::studies {

// Texts of messages moved to core, where file formats of other folders need them too.
using retrace::alternatives;
using retrace::closest;
using retrace::in_quotes;
using retrace::printable;

}  // namespace retrace::studies
