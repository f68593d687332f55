"""A test double of a worker, for a BuildGrid on this machine, for `measure`: `python worker.py ADDRESS FOLDER NAME`.

BuildGrid, from PyPI, is the scheduler, the queue, the action cache and the storage. Its usual worker (buildbox-worker) is on no
package registry, so this one speaks the same protocol (Remote Workers API, v1test2): it takes one action at a time, lays out its
inputs in an empty folder, runs its command with the action's environment alone, and stores what it wrote. Inputs are kept by their
digests, so the compiler is fetched once.
"""

import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import uuid

import grpc
from buildgrid._protos.build.bazel.remote.execution.v2 import remote_execution_pb2 as re
from buildgrid._protos.build.bazel.remote.execution.v2 import remote_execution_pb2_grpc as re_grpc
from buildgrid._protos.google.bytestream import bytestream_pb2, bytestream_pb2_grpc
from buildgrid._protos.google.devtools.remoteworkers.v1test2 import bots_pb2, bots_pb2_grpc

PENDING, ACTIVE, COMPLETED, CANCELLED = 1, 2, 4, 5
CHUNK = 1 << 20


def digest_of(data):
    return re.Digest(hash=hashlib.sha256(data).hexdigest(), size_bytes=len(data))


class Storage:
    """The storage of the cluster, with a folder of what was fetched."""

    def __init__(self, channel, folder):
        self.cas = re_grpc.ContentAddressableStorageStub(channel)
        self.bytes = bytestream_pb2_grpc.ByteStreamStub(channel)
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        self.fetched = 0

    def file(self, digest):
        """The path of a blob."""
        path = self.folder / digest.hash
        if not path.exists():
            parts = []
            if digest.size_bytes:
                request = bytestream_pb2.ReadRequest(resource_name=f"blobs/{digest.hash}/{digest.size_bytes}")
                parts = [response.data for response in self.bytes.Read(request)]
            data = b"".join(parts)
            assert digest_of(data) == digest, "the storage gave other bytes"
            self.fetched += len(data)
            unfinished = path.with_suffix(".tmp")
            unfinished.write_bytes(data)
            # An input may be a program.
            unfinished.chmod(0o555)
            unfinished.rename(path)
        return path

    def message(self, digest, kind):
        return kind.FromString(self.file(digest).read_bytes())

    def put(self, data):
        digest = digest_of(data)
        missing = self.cas.FindMissingBlobs(re.FindMissingBlobsRequest(blob_digests=[digest])).missing_blob_digests
        if missing:
            name = f"uploads/{uuid.uuid4()}/blobs/{digest.hash}/{digest.size_bytes}"

            def requests():
                for start in range(0, max(len(data), 1), CHUNK):
                    end = start + CHUNK >= len(data)
                    yield bytestream_pb2.WriteRequest(
                        resource_name=name, write_offset=start, finish_write=end, data=data[start : start + CHUNK]
                    )

            self.bytes.Write(requests())
        return digest


def lay_out(storage, digest, folder):
    directory = storage.message(digest, re.Directory)
    folder.mkdir(parents=True, exist_ok=True)
    for node in directory.files:
        os.link(storage.file(node.digest), folder / node.name)
    for node in directory.symlinks:
        os.symlink(node.target, folder / node.name)
    for node in directory.directories:
        lay_out(storage, node.digest, folder / node.name)


def tree_of(storage, folder):
    """The message for a folder that an action wrote."""
    children = []

    def directory(path):
        result = re.Directory()
        for entry in sorted(path.iterdir()):
            if entry.is_dir():
                inner = directory(entry)
                children.append(inner)
                digest = digest_of(inner.SerializeToString())
                result.directories.add(name=entry.name, digest=digest)
            else:
                result.files.add(name=entry.name, digest=storage.put(entry.read_bytes()))
        return result

    root = directory(folder)
    return re.Tree(root=root, children=children)


def run(storage, digest, scratch):
    action = storage.message(digest, re.Action)
    command = storage.message(action.command_digest, re.Command)
    root = pathlib.Path(tempfile.mkdtemp(dir=scratch))
    try:
        lay_out(storage, action.input_root_digest, root)
        here = root / command.working_directory
        outputs = list(command.output_paths) or [*command.output_files, *command.output_directories]
        for name in outputs:
            (here / name).parent.mkdir(parents=True, exist_ok=True)
        for name in command.output_directories:
            (here / name).mkdir(parents=True, exist_ok=True)
        environment = {variable.name: variable.value for variable in command.environment_variables}
        done = subprocess.run(list(command.arguments), cwd=here, env=environment, capture_output=True, check=False)
        result = re.ActionResult(exit_code=done.returncode)
        result.stdout_digest.CopyFrom(storage.put(done.stdout))
        result.stderr_digest.CopyFrom(storage.put(done.stderr))
        for name in outputs:
            path = here / name
            if path.is_dir():
                tree = storage.put(tree_of(storage, path).SerializeToString())
                result.output_directories.add(path=name, tree_digest=tree)
            elif path.exists():
                is_executable = os.access(path, os.X_OK)
                result.output_files.add(path=name, digest=storage.put(path.read_bytes()), is_executable=is_executable)
        return result
    finally:
        shutil.rmtree(root, ignore_errors=True)


def main(address, folder, name):
    folder = pathlib.Path(folder)
    scratch = folder / "scratch"
    scratch.mkdir(parents=True, exist_ok=True)
    channel = grpc.insecure_channel(address, options=[("grpc.max_receive_message_length", -1)])
    grpc.channel_ready_future(channel).result(timeout=120)
    storage = Storage(channel, folder / "blobs")
    bots = bots_pb2_grpc.BotsStub(channel)
    session = bots_pb2.BotSession(bot_id=name, status=1)
    session.worker.devices.add(handle=name)
    # The call waits for an action.
    (folder / "ready").touch()
    session = bots.CreateBotSession(bots_pb2.CreateBotSessionRequest(parent="", bot_session=session), timeout=60)
    count = 0
    while True:
        for lease in session.leases:
            if lease.state == PENDING:
                lease.state = ACTIVE
                digest = re.Digest()
                if not lease.payload.Unpack(digest):
                    action = re.Action()
                    lease.payload.Unpack(action)
                    digest = storage.put(action.SerializeToString())
                started = time.monotonic()
                lease.result.Pack(run(storage, digest, scratch))
                lease.state = COMPLETED
                count += 1
                print(f"{name} {count} {time.monotonic() - started:.3f} s {storage.fetched} bytes", flush=True)
            elif lease.state == CANCELLED:
                lease.state = COMPLETED
        try:
            request = bots_pb2.UpdateBotSessionRequest(name=session.name, bot_session=session)
            session = bots.UpdateBotSession(request, timeout=60)
        except grpc.RpcError as error:
            if error.code() not in (grpc.StatusCode.DEADLINE_EXCEEDED, grpc.StatusCode.UNAVAILABLE):
                raise
            time.sleep(0.2)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:4])
    except KeyboardInterrupt:
        pass
