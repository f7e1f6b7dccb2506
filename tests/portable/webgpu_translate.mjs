// Translates a shader of the library to WGSL, for one pipeline. ENGINES.md lists the steps.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import * as naga from 'naga-wasm';

// WebGPU's format for the number of a VkFormat. Without the feature texture-formats-tier1, formats of
// 32 bits take the place of those that cannot be stored.
export const formats = {
  9: 'r32float', 37: 'rgba8unorm', 38: 'rgba8snorm', 64: 'rgba32float', 74: 'r32uint',
  76: 'r32float', 77: 'rg32float', 83: 'rg32float', 92: 'rgba32float', 97: 'rgba16float',
  100: 'r32float', 101: 'rg32uint', 107: 'rgba32uint', 109: 'rgba32float'
};

// r32float -> R32f
const spirvFormat = format => format[0].toUpperCase() + format.slice(1).replace('float', 'f')
    .replace('uint', 'ui').replace('unorm', '').replace('snorm', 'Snorm');

// Gives the specialisation constants their values.
function freeze(folder, shader, constants) {
  const { shaders } = JSON.parse(readFileSync(`${folder}/interfaces.json`));
  const types = shaders.find(({ name }) => name === shader).constants;
  const values = constants.map(({ id, value }) =>
      `${id}:${types.find(type => type.id === id).type === 'bool' ? value === 1 : value}`);
  return execFileSync('spirv-opt', [
    ...(values.length ? [`--set-spec-const-default-value=${values.join(' ')}`] : []),
    '--freeze-spec-const', '--fold-spec-const-op-composite', '--ccp', '--eliminate-dead-branches',
    '--merge-blocks', '--eliminate-dead-code-aggressive', `${folder}/${shader}.spv`, '-o', '-'
  ]);
}

// Writes formats, by binding, into the types of the storage images of a disassembled module.
function writeFormats(text, formatOf) {
  const groupsOf = pattern => [...text.matchAll(pattern)].map(match => match.slice(1));
  const binding = new Map(groupsOf(/OpDecorate (%\d+) Binding (\d+)/g));
  const images = new Map(groupsOf(/(%\d+) = (OpTypeImage %\d+ 2D 0 0 0 2) Unknown/g));
  const pointers = new Map(groupsOf(/(%\d+) = OpTypePointer UniformConstant (%\d+)/g)
      .filter(([, image]) => images.has(image)));
  const variables = groupsOf(/(%\d+) = OpVariable (%\d+) UniformConstant/g)
      .filter(([, pointer]) => pointers.has(pointer))
      .map(([id, pointer]) => ({ id, pointer, format: spirvFormat(formatOf[binding.get(id)]) }));
  const typesFor = pointer => [...new Set(variables.filter(variable => variable.pointer === pointer)
      .map(({ format }) => `%image_${format} = ${images.get(pointers.get(pointer))} ${format}\n` +
           `%pointer_${format} = OpTypePointer UniformConstant %image_${format}\n`))].join('');
  text = text.replace('StorageImageWriteWithoutFormat', 'StorageImageExtendedFormats')
      .replace(/.* = OpTypeImage .* 2 Unknown\n/g, '')
      .replace(/ *(%\d+) = OpTypePointer UniformConstant %\d+\n/g,
               (line, id) => pointers.has(id) ? typesFor(id) : line);
  for (const { id, pointer, format } of variables)
    text = text.replace(`${id} = OpVariable ${pointer} `, `${id} = OpVariable %pointer_${format} `)
        .replace(new RegExp(`OpLoad %\\d+ ${id}\\n`, 'g'), `OpLoad %image_${format} ${id}\n`);
  return text;
}

export function translate(folder, shader, constants, formatOf) {
  const text = execFileSync('spirv-dis', ['--raw-id', '-'],
      { input: freeze(folder, shader, constants), encoding: 'utf8', maxBuffer: 2 ** 26 });
  const module = naga.parseSpirv(new Uint8Array(execFileSync('spirv-as',
      ['--target-env', 'vulkan1.2', '-o', '-', '-'], { input: writeFormats(text, formatOf) })));
  // A loop whose only exit is a `break` at its end becomes a block: SwiftShader takes minutes for the former.
  const loops = /^( *)loop \{\n((?:\1 .*\n|\n)*?)\1\}$/gm;
  return naga.writeWgsl(module, naga.validate(module), {}).replace(loops, (loop, indent, body) => {
    const once = body.endsWith(`${indent}    break;\n`) ? body.slice(0, -`${indent}    break;\n`.length) : 'break';
    return /\b(break|continue|continuing)\b/.test(once.replace(loops, '')) ? loop : `${indent}{\n${once}${indent}}`;
  });
}
