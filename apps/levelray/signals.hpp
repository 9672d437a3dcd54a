// What the program does when it is told to stop.
#pragma once

namespace levelray {

// SIGINT, SIGTERM and SIGHUP ask running work to stop (request_cancel); work that has not stopped 0.25
// seconds later, or a second signal, ends the process at once, without temporary files left, with exit code
// 128 + signal. SIGPIPE and SIGXFSZ become errors of the write that caused them.
void handle_signals();

// The signal that asked to stop, or 0.
int stop_signal();

// Ends the process as SIGPIPE does by default: quietly.
[[noreturn]] void die_of_broken_pipe();

// Opens /dev/null in the place of standard streams that the caller closed, so that no output file gets their
// number. Returns whether standard output was closed.
bool reserve_standard_streams();

} // namespace levelray
