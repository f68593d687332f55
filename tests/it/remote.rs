//! The remote cache by HTTPS and gRPC: two machines share results through a server that is not ours (BuildGrid), and through one
//! with a certificate; a server that is gone, or that nobody trusts, is a warning.
//!
//! If BuildGrid, Python or OpenSSL is missing, the test says so; if `CI` is set, it fails.

use crate::cache::{compile_in, files, project};
use crate::cli::Folder;
use crate::emit::missing;
use crate::support::root;
use std::env;
use std::fs;
use std::io::{BufRead, BufReader};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Storage and results of BuildGrid, without a scheduler.
const CONFIGURATION: &str = "
server:
  - !channel
    address: {address}
    insecure-mode: true
authorization:
  method: none
monitoring:
  enabled: false
storages:
  - !disk-storage &storage
    path: {folder}/storage
caches:
  - !lru-action-cache &cache
    storage: *storage
    max-cached-refs: 1000
    allow-updates: true
    cache-failed-actions: false
instances:
  - name: team
    services:
      - !action-cache
        cache: *cache
      - !cas
        storage: *storage
";

/// Serves `GET` and `PUT` by HTTPS, and prints its port.
const HTTPS: &str = "
import http.server, ssl, sys
kept = {}
class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = 'HTTP/1.1'
    def answer(self, status, body=b''):
        self.send_response(status)
        self.send_header('Content-Length', str(len(body)))
        self.end_headers()
        self.wfile.write(body)
    def do_GET(self):
        self.answer(200, kept[self.path]) if self.path in kept else self.answer(404)
    def do_PUT(self):
        kept[self.path] = self.rfile.read(int(self.headers['Content-Length']))
        self.answer(200)
    def log_message(self, *_):
        pass
server = http.server.ThreadingHTTPServer(('127.0.0.1', 0), Handler)
context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
context.load_cert_chain(sys.argv[1], sys.argv[2])
server.socket = context.wrap_socket(server.socket, server_side=True)
print(server.server_address[1], flush=True)
server.serve_forever()
";

/// A process that ends with the test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A project that has compiled with this address, what was told, and whether it was a hit.
fn compiled(address: &str, variables: &[(&str, &Path)]) -> (Folder, bool, String) {
    let folder = project();
    let (is_hit, told) = compile_in(&folder, &["--remote-cache", address], variables);
    (folder, is_hit, told)
}

/// The second machine gets what the first one made.
fn shares(address: &str, variables: &[(&str, &Path)]) {
    let (here, is_hit, told) = compiled(address, variables);
    assert!(!is_hit && !told.contains("remote cache"), "{told}");
    let (there, is_hit, again) = compiled(address, variables);
    assert!(is_hit, "{again}");
    assert_eq!(told, again);
    assert!(files(&here.path("out")) == files(&there.path("out")), "the files differ");
    assert!(compile_in(&there, &[], variables).0, "it is kept on disk");
}

#[test]
fn machines_share_results_through_buildgrid() {
    let own = root().join("target/buildgrid/bin/python");
    let python = env::var_os("GLISTEN_BUILDGRID").map_or(own, PathBuf::from);
    if !python.is_file() {
        return missing("BuildGrid", "make the environment target/buildgrid with `pip install buildgrid==0.0.86`");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let address = TcpListener::bind("127.0.0.1:0").and_then(|free| free.local_addr()).expect("a port").to_string();
    let text = CONFIGURATION.replace("{address}", &address).replace("{folder}", &folder.path().to_string_lossy());
    let file = folder.path().join("server.yml");
    fs::write(&file, text).expect("written");
    let mut command = Command::new(python.with_file_name("bgd"));
    command.args(["server", "start"]).arg(&file).stdout(Stdio::null()).stderr(Stdio::null());
    let mut server = Running(command.spawn().expect("it starts"));
    let began = Instant::now();
    while TcpStream::connect(&address).is_err() {
        assert!(server.0.try_wait().expect("a state").is_none(), "BuildGrid has ended");
        assert!(began.elapsed() < Duration::from_secs(120), "BuildGrid does not answer");
        std::thread::sleep(Duration::from_millis(100));
    }
    shares(&format!("grpc://{address}/team"), &[]);
    let (_, is_hit, told) = compiled(&format!("grpc://{address}/nobody"), &[]);
    assert!(!is_hit && told.contains("remote cache `grpc://"), "{told}");
    drop(server);
    let (_, is_hit, told) = compiled(&format!("grpc://{address}/team"), &[]);
    assert!(!is_hit && told.contains("the build goes on without it"), "{told}");
}

#[test]
fn machines_share_results_by_https() {
    let folder = tempfile::tempdir().expect("a folder");
    let [certificate, key] = ["cert.pem", "key.pem"].map(|name| folder.path().join(name));
    let mut command = Command::new("openssl");
    command.args(["req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2"]);
    command.args(["-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1", "-addext"]);
    command.args(["basicConstraints=critical,CA:FALSE", "-keyout"]).arg(&key).arg("-out").arg(&certificate);
    if !command.output().is_ok_and(|made| made.status.success()) {
        return missing("OpenSSL", "Debian has it in the package openssl");
    }
    let mut command = Command::new("python3");
    command.args(["-c", HTTPS]).args([&certificate, &key]).stdout(Stdio::piped()).stderr(Stdio::null());
    let Ok(server) = command.spawn() else { return missing("Python", "Debian has it in the package python3") };
    let mut server = Running(server);
    let mut port = String::new();
    let output = server.0.stdout.take().expect("a pipe");
    BufReader::new(output).read_line(&mut port).expect("a port");
    let address = format!("https://127.0.0.1:{}", port.trim());
    shares(&address, &[("SSL_CERT_FILE", &certificate)]);
    let (_, is_hit, told) = compiled(&address, &[("SSL_CERT_FILE", Path::new("/dev/null"))]);
    assert!(!is_hit && told.contains("remote cache `https://"), "{told}");
}
