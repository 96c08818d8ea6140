#!/usr/bin/env python3
"""How long a command goes on after Ctrl-C, at moments all over its work: by the clock, and in seconds of the processor, which
other load does not lengthen.

usage: cancel_moments.py [--moments 24] [--most 2.0] -- COMMAND [ARGUMENT ...]

The command runs once to its end, which tells how much processor time it takes; then it is interrupted after each part of that.
Exits with 1 where it went on for more than --most seconds of the processor's time, which no clock can beat.
"""
import argparse
import os
import re
import select
import signal
import sys
import time

parser = argparse.ArgumentParser()
parser.add_argument("--moments", type=int, default=24)
parser.add_argument("--most", type=float, default=2.0)
parser.add_argument("command", nargs="+")
arguments = parser.parse_args()
TICKS = os.sysconf("SC_CLK_TCK")


def processor_s(pid):
    """Seconds of the processor that a process took so far."""
    with open(f"/proc/{pid}/stat") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


class Run:
    """The command on a terminal of its own, so that it says what it does."""

    def __init__(self):
        self.pid, self.terminal = os.forkpty()
        if self.pid == 0:
            null = os.open(os.devnull, os.O_WRONLY)
            os.dup2(null, 1)
            os.execvp(arguments.command[0], arguments.command)
        self.stage = ""

    def listen(self, seconds):
        """False where the command has ended."""
        if not select.select([self.terminal], [], [], seconds)[0]:
            return True
        try:
            said = os.read(self.terminal, 65536).decode(errors="replace")
        except OSError:
            return False
        stages = re.findall(r"\d+ % ([^\r\x1b]+)", said)
        self.stage = stages[-1].strip() if stages else self.stage
        return said != ""

    def until(self, spent_s):
        """Waits for so much processor time; false where the command ended before."""
        while self.listen(0.01):
            if processor_s(self.pid) >= spent_s:
                return True
        return False

    def end(self):
        """Its exit status and all the processor time it took."""
        while self.listen(1.0):
            pass
        _, status, usage = os.wait4(self.pid, 0)
        os.close(self.terminal)
        return os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime


first = Run()
status, whole_s = first.end()
print(f"whole: {whole_s:.1f} s of the processor, exit status {status}\n\n   after s   clock s   processor s   exit   doing")
worst = 0.0
for moment in range(arguments.moments):
    run = Run()
    after_s = whole_s * (moment + 0.5) / arguments.moments
    if not run.until(after_s):
        run.end()
        continue
    spent, begun = processor_s(run.pid), time.monotonic()
    os.kill(run.pid, signal.SIGINT)
    status, all_s = run.end()
    went_on = max(0.0, all_s - spent)
    worst = max(worst, went_on)
    print(f"{after_s:10.2f}{time.monotonic() - begun:10.2f}{went_on:14.2f}{status:7d}   {run.stage}", flush=True)
print(f"\nat most {worst:.2f} s of the processor after Ctrl-C")
sys.exit(1 if worst > arguments.most else 0)
