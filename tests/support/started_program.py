"""A program that is run many times, and need not be loaded each time, see
fork_server.cc."""
import os
import select
import signal
import subprocess
import tempfile


class StartedProgram:
    """Runs PROGRAM. SERVER is the library fork_server, or empty: then it is started anew
    each time. Runs have the environment of the first one, and one is at an end before the
    next begins. ERRORS: what becomes of bytes that they print and that are no text."""

    def __init__(self, program, server='', errors='strict'):
        self.program, self.server, self.errors = program, server, errors
        self.process = None

    def run(self, arguments, timeout=120):
        """As subprocess.run() with texts of standard output and standard error."""
        with tempfile.NamedTemporaryFile() as out, tempfile.NamedTemporaryFile() as err:
            words = [self.program, *arguments]
            if self.server:
                status = self.ask([os.getcwd(), out.name, err.name, *words], timeout)
            else:
                status = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=out,
                                        stderr=err, timeout=timeout).returncode
            texts = [file.read().decode('utf-8', self.errors)
                     for file in map(open_bytes, (out, err))]
        return subprocess.CompletedProcess(words, status, *texts)

    def ask(self, words, timeout):
        if any('\0' in word for word in words):
            raise ValueError('embedded null byte')  # as subprocess.run() does
        if self.process is None:
            self.process = subprocess.Popen(
                [self.program], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                start_new_session=True, env=dict(os.environ, LD_PRELOAD=self.server))
        request = [str(len(words)), *words]
        self.process.stdin.write(b''.join(os.fsencode(w) + b'\0' for w in request))
        self.process.stdin.flush()
        if not select.select([self.process.stdout], [], [], timeout)[0]:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.close()
            raise subprocess.TimeoutExpired(words, timeout)
        answer = self.process.stdout.readline()
        if not answer:
            raise ChildProcessError('The fork server of %s has ended.' % self.program)
        return int(answer)

    def close(self):
        if self.process:
            self.process.communicate()
        self.process = None


def open_bytes(file):
    return open(file.name, 'rb')
