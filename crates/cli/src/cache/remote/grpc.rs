//! [`Grpc`]: Bazel's gRPC protocol.
//!
//! *In:* the name of an entry. *Out:* calls of the services `ActionCache` and `ContentAddressableStorage` of
//! <https://github.com/bazelbuild/remote-apis>, `build.bazel.remote.execution.v2`, as BuildGrid, bazel-remote, BuildBarn and others
//! serve them. *Not done here:* entries larger than a message may be (4 MiB) stay on this machine.

use super::super::action::{ActionResult, SizedDigest};
use super::super::store::Kind;
use super::{Name, Server};
use ::http::uri::PathAndQuery;
use prost::Message;
use std::time::Duration;
use tokio::runtime::{Builder, Runtime};
use tonic::transport::{Channel, ClientTlsConfig, Endpoint};
use tonic::{Code, Request, Status};
use tonic_prost::ProstCodec;

/// The largest entry of one message: that of gRPC, less room for the names in it.
const MAX_ENTRY: usize = (4 << 20) - (64 << 10);
/// The number of bytes of an action, which is not kept: a server looks an action up by its digest.
const ACTION_BYTES: i64 = 64;

const READ: &str = "/build.bazel.remote.execution.v2.ContentAddressableStorage/BatchReadBlobs";
const WRITE: &str = "/build.bazel.remote.execution.v2.ContentAddressableStorage/BatchUpdateBlobs";
const GET_RESULT: &str = "/build.bazel.remote.execution.v2.ActionCache/GetActionResult";
const UPDATE_RESULT: &str = "/build.bazel.remote.execution.v2.ActionCache/UpdateActionResult";

/// A server.
pub(super) struct Grpc {
    runtime: Runtime,
    channel: Channel,
    /// The name of the instance on the server.
    instance: String,
}

#[derive(Clone, PartialEq, Message)]
struct ResultRequest {
    #[prost(string, tag = "1")]
    instance_name: String,
    #[prost(message, optional, tag = "2")]
    action_digest: Option<SizedDigest>,
    /// With an update.
    #[prost(message, optional, tag = "3")]
    action_result: Option<ActionResult>,
}

#[derive(Clone, PartialEq, Message)]
struct ReadRequest {
    #[prost(string, tag = "1")]
    instance_name: String,
    #[prost(message, repeated, tag = "2")]
    digests: Vec<SizedDigest>,
}

#[derive(Clone, PartialEq, Message)]
struct ReadAnswer {
    #[prost(message, repeated, tag = "1")]
    responses: Vec<Blob>,
}

#[derive(Clone, PartialEq, Message)]
struct WriteRequest {
    #[prost(string, tag = "1")]
    instance_name: String,
    #[prost(message, repeated, tag = "2")]
    requests: Vec<Blob>,
}

#[derive(Clone, PartialEq, Message)]
struct WriteAnswer {
    #[prost(message, repeated, tag = "1")]
    responses: Vec<Written>,
}

/// Bytes, in a request to write and in the answer to a request to read.
#[derive(Clone, PartialEq, Message)]
struct Blob {
    #[prost(message, optional, tag = "1")]
    digest: Option<SizedDigest>,
    #[prost(bytes = "vec", tag = "2")]
    data: Vec<u8>,
    /// Only in answers.
    #[prost(message, optional, tag = "3")]
    status: Option<Outcome>,
}

#[derive(Clone, PartialEq, Message)]
struct Written {
    #[prost(message, optional, tag = "2")]
    status: Option<Outcome>,
}

/// `google.rpc.Status`.
#[derive(Clone, PartialEq, Message)]
struct Outcome {
    #[prost(int32, tag = "1")]
    code: i32,
    #[prost(string, tag = "2")]
    message: String,
}

impl Grpc {
    /// The server at `host:port`, or an instance of it, `host:port/name`.
    ///
    /// # Errors
    /// An address that is none.
    pub(super) fn new(scheme: &str, rest: &str, connect: Duration, answer: Duration) -> Result<Self, String> {
        let (host, instance) = rest.split_once('/').unwrap_or((rest, ""));
        let address = |error: tonic::transport::Error| format!("`{host}` is no address: {error}");
        let mut endpoint = Endpoint::from_shared(format!("{scheme}://{host}")).map_err(address)?;
        endpoint = endpoint.connect_timeout(connect).timeout(answer);
        if scheme == "https" {
            endpoint = endpoint.tls_config(ClientTlsConfig::new().with_native_roots()).map_err(address)?;
        }
        let started = Builder::new_multi_thread().worker_threads(1).enable_io().enable_time().build();
        let runtime = started.map_err(|error| format!("no thread for gRPC can be started: {error}"))?;
        let channel = {
            let _inside = runtime.enter();
            endpoint.connect_lazy()
        };
        Ok(Self { runtime, channel, instance: instance.to_owned() })
    }

    fn call<Q, A>(&self, path: &'static str, message: Q) -> Result<A, Status>
    where
        Q: Message + 'static,
        A: Message + Default + 'static,
    {
        let mut client = tonic::client::Grpc::new(self.channel.clone());
        self.runtime.block_on(async move {
            client.ready().await.map_err(|error| Status::unavailable(error.to_string()))?;
            let path = PathAndQuery::from_static(path);
            let answer = client.unary(Request::new(message), path, ProstCodec::<Q, A>::default()).await?;
            Ok(answer.into_inner())
        })
    }

    fn result_request(&self, name: Name, action_result: Option<ActionResult>) -> ResultRequest {
        let digest = SizedDigest { hash: name.digest.to_string(), size_bytes: ACTION_BYTES };
        ResultRequest { instance_name: self.instance.clone(), action_digest: Some(digest), action_result }
    }

    fn read(&self, name: Name) -> Result<Option<Vec<u8>>, Status> {
        let Some(digest) = sized(name) else { return Ok(None) };
        let request = ReadRequest { instance_name: self.instance.clone(), digests: vec![digest] };
        let answer: ReadAnswer = self.call(READ, request)?;
        let Some(blob) = answer.responses.into_iter().next() else { return Ok(None) };
        Ok(well(blob.status.as_ref()).then_some(blob.data))
    }

    fn write(&self, name: Name, bytes: &[u8]) -> Result<(), Status> {
        let Some(digest) = sized(name) else { return Ok(()) };
        let blob = Blob { digest: Some(digest), data: bytes.to_vec(), status: None };
        let request = WriteRequest { instance_name: self.instance.clone(), requests: vec![blob] };
        let answer: WriteAnswer = self.call(WRITE, request)?;
        match answer.responses.into_iter().find_map(|one| one.status.filter(|status| status.code != 0)) {
            Some(failed) => Err(Status::new(Code::from(failed.code), failed.message)),
            None => Ok(()),
        }
    }
}

/// The digest of bytes that fit into a message.
fn sized(name: Name) -> Option<SizedDigest> {
    let bytes = name.bytes.filter(|bytes| *bytes <= MAX_ENTRY)?;
    Some(SizedDigest { hash: name.digest.to_string(), size_bytes: bytes as i64 })
}

fn well(status: Option<&Outcome>) -> bool {
    status.is_none_or(|status| status.code == 0)
}

/// The failure in a line.
fn told(status: &Status) -> String {
    let message = status.message();
    if message.is_empty() { status.code().to_string() } else { message.to_owned() }
}

impl Server for Grpc {
    fn get(&self, name: Name) -> Result<Option<Vec<u8>>, String> {
        let found = match name.kind {
            Kind::Bytes => self.read(name),
            Kind::Result => {
                let found: Result<ActionResult, Status> = self.call(GET_RESULT, self.result_request(name, None));
                found.map(|result| Some(result.encode_to_vec()))
            }
        };
        match found {
            Err(status) if status.code() == Code::NotFound => Ok(None),
            other => other.map_err(|status| told(&status)),
        }
    }

    fn put(&self, name: Name, bytes: &[u8]) -> Result<(), String> {
        let written = match name.kind {
            Kind::Bytes => self.write(name, bytes),
            _ if bytes.len() > MAX_ENTRY => Ok(()),
            Kind::Result => {
                let result = ActionResult::decode(bytes).map_err(|error| error.to_string())?;
                self.call::<_, ActionResult>(UPDATE_RESULT, self.result_request(name, Some(result))).map(drop)
            }
        };
        written.map_err(|status| told(&status))
    }
}
