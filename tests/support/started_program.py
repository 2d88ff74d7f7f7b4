"""A program that is run many times, and need not be loaded each time, see
fork_server.cc."""
import os
import select
import signal
import subprocess
import tempfile


class NoArgument(ValueError):
    """What no program can be given."""


class StartedProgram:
    """Runs PROGRAM. SERVER is the library fork_server, or empty: then it is started anew
    each time. Runs have the environment of the first one, and one is at an end before the
    next begins. ERRORS: what becomes of bytes that they print and that are no text."""

    def __init__(self, program, server='', errors='strict'):
        self.program, self.server, self.errors = program, server, errors
        self.process = None

    def run(self, arguments, timeout=120):
        """As subprocess.run() with texts of standard output and standard error; an
        argument that cannot be given is a NoArgument."""
        with tempfile.NamedTemporaryFile() as out, tempfile.NamedTemporaryFile() as err:
            words = [self.program, *arguments]
            ended = None
            if self.server:
                try:
                    status = self.ask([os.getcwd(), out.name, err.name, *words], timeout)
                except subprocess.TimeoutExpired as error:
                    ended = error
            else:
                status = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=out,
                                        stderr=err, timeout=timeout).returncode
            texts = [file.read().decode('utf-8', self.errors)
                     for file in map(open_bytes, (out, err))]
        if ended:
            ended.output, ended.stderr = texts
            raise ended
        return subprocess.CompletedProcess(words, status, *texts)

    def ask(self, words, timeout):
        request = [str(len(words)), *words]
        try:
            data = [os.fsencode(word) for word in request]
        except UnicodeEncodeError as error:
            raise NoArgument(str(error)) from None
        if any(b'\0' in word for word in data):
            raise NoArgument('embedded null byte')
        if self.process is None:
            self.process = subprocess.Popen(
                [self.program], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                start_new_session=True, env=dict(os.environ, LD_PRELOAD=self.server))
        try:
            self.process.stdin.write(b''.join(word + b'\0' for word in data))
            self.process.stdin.flush()
            if not select.select([self.process.stdout], [], [], timeout)[0]:
                raise subprocess.TimeoutExpired(words, timeout)
            answer = self.process.stdout.readline()
        except BaseException:  # also if the user has had enough of it
            os.killpg(self.process.pid, signal.SIGKILL)
            self.close()
            raise
        if not answer:
            raise ChildProcessError('The fork server of %s has ended.' % self.program)
        return int(answer)

    def close(self):
        if self.process:
            self.process.communicate()
        self.process = None


def open_bytes(file):
    return open(file.name, 'rb')
