//! [`Remote`]: a cache on another machine, by Bazel's protocols.
//!
//! *In:* a kind, a digest, bytes. *Out:* the same bytes on another machine, from a server of HTTP ([`http`]) or gRPC. *Holds:* after
//! a failure the server is left alone, and the build goes on without it; bytes that do not fit their digest are not taken.

#[cfg(feature = "remote")]
mod grpc;
mod http;

use super::store::Kind;
use crate::digest::Digest;
use std::sync::Mutex;
use std::time::Duration;

/// How long to wait for a connection, and for an answer as a whole.
const CONNECT: Duration = Duration::from_secs(3);
const ANSWER: Duration = Duration::from_secs(30);
/// The largest entry that is taken.
const MAX_BYTES: usize = 256 << 20;

/// An entry of a server.
#[derive(Clone, Copy, Debug)]
pub(super) struct Name {
    /// Its kind.
    pub(super) kind: Kind,
    /// Its digest.
    pub(super) digest: Digest,
    /// The number of its bytes, where it is known.
    #[cfg_attr(not(feature = "remote"), expect(dead_code, reason = "only gRPC asks for it"))]
    pub(super) bytes: Option<usize>,
}

/// A protocol.
trait Server: Send + Sync {
    /// The bytes of an entry, if the server has it.
    fn get(&self, name: Name) -> Result<Option<Vec<u8>>, String>;
    /// Keeps an entry.
    fn put(&self, name: Name, bytes: &[u8]) -> Result<(), String>;
}

/// A server.
pub(super) struct Remote {
    server: Box<dyn Server>,
    address: String,
    /// Why the server is asked no more.
    failure: Mutex<Option<String>>,
}

impl Remote {
    /// The server at an address.
    ///
    /// # Errors
    /// An address that is none, or whose protocol this program is built without.
    pub(super) fn new(address: &str) -> Result<Self, String> {
        let address = address.trim_end_matches('/');
        let host = address.split_once("://").map_or("", |(_, host)| host);
        if host.is_empty() || host.starts_with('/') || host.contains(char::is_whitespace) {
            return Err(format!("`{address}` is no address; write `http://host:port`"));
        }
        let server = server(address)?;
        Ok(Self { server, address: address.to_owned(), failure: Mutex::new(None) })
    }

    /// The failure of the server, told once.
    pub(super) fn failure(&self) -> Option<String> {
        self.failure.lock().ok()?.clone()
    }

    fn is_down(&self) -> bool {
        self.failure.lock().map_or(true, |failure| failure.is_some())
    }

    fn fail(&self, verb: &str, why: &str) {
        if let Ok(mut failure) = self.failure.lock() {
            failure.get_or_insert_with(|| format!("cannot {verb} the remote cache `{}`: {why}", self.address));
        }
    }

    /// The bytes of an entry.
    pub(super) fn get(&self, name: Name) -> Option<Vec<u8>> {
        if self.is_down() {
            return None;
        }
        match self.server.get(name) {
            Ok(bytes) => bytes.filter(|bytes| name.kind == Kind::Result || Digest::of(bytes) == name.digest),
            Err(why) => {
                self.fail("read from", &why);
                None
            }
        }
    }

    /// Keeps an entry.
    pub(super) fn put(&self, name: Name, bytes: &[u8]) {
        if !self.is_down()
            && let Err(why) = self.server.put(name, bytes)
        {
            self.fail("write to", &why);
        }
    }
}

/// The protocol of an address.
fn server(address: &str) -> Result<Box<dyn Server>, String> {
    match address.split_once("://") {
        Some(("http", _)) => Ok(Box::new(http::Http::new(address, CONNECT, ANSWER))),
        #[cfg(feature = "remote")]
        Some(("https", _)) => Ok(Box::new(http::Http::new(address, CONNECT, ANSWER))),
        #[cfg(feature = "remote")]
        Some(("grpc", rest)) => Ok(Box::new(grpc::Grpc::new("http", rest, CONNECT, ANSWER)?)),
        #[cfg(feature = "remote")]
        Some(("grpcs", rest)) => Ok(Box::new(grpc::Grpc::new("https", rest, CONNECT, ANSWER)?)),
        #[cfg(not(feature = "remote"))]
        Some((protocol @ ("https" | "grpc" | "grpcs"), _)) => Err(format!(
            "`{address}`: this glisten speaks plain HTTP alone; build it with `--features remote` for {protocol}"
        )),
        _ => Err(format!("`{address}` is no address; write `http://`, `https://`, `grpc://` or `grpcs://` and a host")),
    }
}

#[cfg(test)]
mod tests {
    use super::Remote;

    #[test]
    fn addresses_have_a_protocol_and_a_host() {
        for address in ["http://localhost:8080", "http://cache.example/team/"] {
            assert!(Remote::new(address).is_ok(), "{address}");
        }
        for address in ["https://cache.example", "grpc://host:9092/team", "grpcs://host"] {
            assert_eq!(Remote::new(address).is_ok(), cfg!(feature = "remote"), "{address}");
        }
        for address in ["localhost:8080", "ftp://host", "http://", "http:///ac", "http:// a", "grpc://ho st"] {
            assert!(Remote::new(address).is_err(), "{address}");
        }
    }
}
