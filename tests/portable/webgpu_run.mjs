// Executes a list of work on WebGPU without optional features and compares its images with those of
// Vulkan. All limits but one are the defaults. webgpu_lists.cpp writes the list.
// node webgpu_run.mjs FOLDER_OF_SHADERS LIST.json
import { readFileSync } from 'node:fs';
import { create, globals } from 'webgpu';
import { formats, translate } from './webgpu_translate.mjs';

Object.assign(globalThis, globals);
// The share counts all values of an image; the difference is in units of 1/255 of its range.
const LARGEST_SHARE_THAT_DIFFERS = 0.002, LARGEST_DIFFERENCE = 8;
const PARAMETERS = 0, TABLE = 1, SAMPLER = 2, STORAGE_IMAGE = 4;  // AlcoveBindingType
const INPUT = 0, OUTPUT = 1, HISTORY_PREVIOUS = 3, HISTORY_CURRENT = 4, BUFFER = 5;  // AlcoveResourceKind

const [shaders, listFile] = process.argv.slice(2);
const { inputs, frames } = JSON.parse(readFileSync(listFile, 'utf8'));
const storageTextures = Math.max(4, ...frames.flatMap(({ dispatches }) => dispatches).map(
    ({ bindings }) => bindings.filter(({ type }) => type === STORAGE_IMAGE).length));
const instance = create([]);
const device = await (await instance.requestAdapter()).requestDevice(
    { requiredLimits: { maxStorageTexturesPerShaderStage: storageTextures } });
const errors = [];
device.onuncapturederror = ({ error }) => errors.push(error.message);

const channelsOf = ({ size: [width, height] }, values) => values.length / (width * height);
const floats = ['', 'r32float', 'rg32float', '', 'rgba32float'];  // by the number of channels

function createBuffer(bytes, usage) {
  const size = Math.ceil(bytes.length / 16) * 16;
  const buffer = device.createBuffer({ size, usage: usage | GPUBufferUsage.COPY_DST });
  device.queue.writeBuffer(buffer, 0, Uint8Array.from({ ...bytes, length: size }));
  return buffer;
}

// Returns the texture or buffer of a resource. The two textures of a history change places.
const objects = new Map();
function objectOf(resource, index, frame) {
  const { name, kind, role, size, format, data } = resource;
  const slot = kind === HISTORY_PREVIOUS ? index + 1 : kind === HISTORY_CURRENT ? index : 0;
  const key = [name, format, size, slot % 2].join();
  if (objects.has(key)) return objects.get(key);
  const host = kind === INPUT ? inputs[role] : kind === OUTPUT ? frame.results[role] : undefined;
  const { TEXTURE_BINDING, STORAGE_BINDING, COPY_SRC, COPY_DST } = GPUTextureUsage;
  objects.set(key, kind === BUFFER ? createBuffer(data, GPUBufferUsage.STORAGE) : device.createTexture({
    size, format: host ? floats[channelsOf(resource, host)] : formats[format],
    usage: TEXTURE_BINDING | STORAGE_BINDING | COPY_SRC | COPY_DST
  }));
  if (kind === INPUT)
    device.queue.writeTexture({ texture: objects.get(key) }, new Float32Array(host),
                              { bytesPerRow: size[0] * channelsOf(resource, host) * 4 }, size);
  return objects.get(key);
}

const pipelines = new Map();
function pipelineOf({ shader, constants, bindings }, bound) {
  const formatOf = {};  // of storage images, by binding
  const entries = bindings.map(({ number, type }, i) => {
    const format = bound[i].format;
    if (type === STORAGE_IMAGE) formatOf[number] = format;
    return { binding: number, visibility: GPUShaderStage.COMPUTE, ...[
      { buffer: { type: 'uniform' } }, { buffer: { type: 'storage' } }, { sampler: { type: 'non-filtering' } },
      { texture: { sampleType: format?.endsWith('uint') ? 'uint' : 'unfilterable-float' } },
      { storageTexture: { format } }][type] };
  });
  const key = JSON.stringify([shader, constants, entries]);
  if (pipelines.has(key)) return pipelines.get(key);
  const code = translate(shaders, shader, constants, formatOf);
  const start = performance.now();
  const bindGroupLayouts = [device.createBindGroupLayout({ entries })];
  pipelines.set(key, device.createComputePipeline({
    layout: device.createPipelineLayout({ bindGroupLayouts }),
    compute: { module: device.createShaderModule({ code }), entryPoint: 'main' }
  }));
  console.log(`pipeline of ${shader}: ${code.length} bytes of WGSL, ` +
              `compiled in ${((performance.now() - start) / 1000).toFixed(1)} s`);
  return pipelines.get(key);
}

async function read(texture, channels) {
  const { width, height } = texture, bytesPerRow = Math.ceil(width * channels / 64) * 256;
  const usage = GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ;
  const buffer = device.createBuffer({ size: bytesPerRow * height, usage });
  const encoder = device.createCommandEncoder();
  encoder.copyTextureToBuffer({ texture }, { buffer, bytesPerRow }, [width, height]);
  device.queue.submit([encoder.finish()]);
  await buffer.mapAsync(GPUMapMode.READ);
  return [...new Float32Array(buffer.getMappedRange())]
      .filter((_, i) => i % (bytesPerRow / 4) < width * channels);
}

const sampler = device.createSampler();
for (const [index, frame] of frames.entries()) {
  const frameObjects = frame.resources.map(resource => objectOf(resource, index, frame));
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginComputePass();
  for (const dispatch of frame.dispatches) {
    const parameters = createBuffer(dispatch.parameters, GPUBufferUsage.UNIFORM);
    const bound = dispatch.bindings.map(({ type, resource }) =>
        type === PARAMETERS ? parameters : type === SAMPLER ? sampler : frameObjects[resource]);
    const pipeline = pipelineOf(dispatch, bound);
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, device.createBindGroup({
      layout: pipeline.getBindGroupLayout(0),
      entries: dispatch.bindings.map(({ number: binding, type }, i) => ({ binding, resource:
        type <= TABLE ? { buffer: bound[i] } : type === SAMPLER ? sampler : bound[i].createView() }))
    }));
    pass.dispatchWorkgroups(...dispatch.groups);
  }
  pass.end();
  device.queue.submit([encoder.finish()]);
  for (const [i, resource] of frame.resources.entries()) {
    if (resource.kind !== OUTPUT) continue;
    const expected = frame.results[resource.role];
    const stepsPerUnit = expected.some(value => value < 0) ? 255 / 2 : 255;  // bent normals: -1 to 1
    const steps = (await read(frameObjects[i], channelsOf(resource, expected)))
        .map((value, k) => Math.abs(value - expected[k]) * stepsPerUnit);
    const differing = steps.filter(step => !(step <= 1)).length;
    const largest = steps.reduce((a, b) => b > a || Number.isNaN(b) ? b : a);
    console.log(`frame ${index}, ${resource.name}: ${differing} of ${steps.length} values differ by ` +
                `more than 1/255, the largest difference is ${largest.toFixed(1)}/255`);
    if (!(differing <= LARGEST_SHARE_THAT_DIFFERS * steps.length && largest <= LARGEST_DIFFERENCE))
      errors.push(`frame ${index}, ${resource.name}: not the image of Vulkan`);
  }
}
errors.forEach(error => console.error(error));
process.exit(errors.length ? 1 : 0);
