"""PostgreSQL servers for scripts: started by server.sh in a folder of their own, and gone at the end."""
import pathlib
import shutil
import subprocess
import sys
import tempfile

SCRIPT = str(pathlib.Path(__file__).parent / "server.sh")


def skip_without_server():
    """Ends the script, with words, where the server's programs are not installed."""
    if subprocess.run([SCRIPT, "available"]).returncode != 0:
        print(f"SKIPPED {pathlib.Path(sys.argv[0]).name}: no PostgreSQL server is installed (deploy/install.sh --test installs it)")
        sys.exit(77)


class PostgresServer:
    def __init__(self, standby_of=None):
        self.folder = tempfile.mkdtemp(prefix="slipway-pg-", dir="/tmp")
        self.begun = ["standby", standby_of.folder, self.folder] if standby_of else ["start", self.folder]
        self.address = self._script(*self.begun)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if (pathlib.Path(self.folder) / "data" / "postmaster.pid").exists():
            subprocess.run([SCRIPT, "stop", self.folder, "immediate"], capture_output=True)
        shutil.rmtree(self.folder, ignore_errors=True)

    @property
    def place(self):
        """Host and port."""
        return self.address.split("@")[1].split("/")[0]

    def start(self):
        self._script("start", self.folder)

    def kill(self, how="kill"):
        self._script("stop", self.folder, how)

    def promote(self):
        self._script("promote", self.folder)

    def query(self, sql):
        return subprocess.run(["psql", "-X", "-q", "-A", "-t", "-d", self.address, "-c", sql], check=True, capture_output=True,
                              text=True).stdout.strip()

    @staticmethod
    def _script(*words):
        return subprocess.run([SCRIPT, *words], check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
