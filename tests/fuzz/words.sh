# Sourced by tests/fuzz/run: words that inputs are likely to be made of.

# words_of TARGET: a dictionary for libFuzzer, from the documents that describe the target's input.
words_of() {
  case $1 in
    messages | connection) quoted protocol/spec/operations.json ;;
    scenes) quoted server/scene/scene.schema.json ;;
    tokens) printf '"%s"\n' tokens without_token role token sha256 name view control admin ;;
    fabrics) quoted server/fabric/fit.cpp ;;
    meshes) printf '"\\x0a%s "\n' v vt vn f l p t g o s vw usemtl mtllib ;;
    motions)
      printf '"%s"\n' HIERARCHY ROOT JOINT OFFSET CHANNELS 'End Site' MOTION Frames: 'Frame Time:' Xposition Zrotation Yrotation
      printf '"\\"%s\\""\n' asset version buffers byteLength bufferViews byteOffset byteStride accessors componentType count type nodes children \
        translation rotation scale matrix animations samplers channels input output interpolation CUBICSPLINE target path skins joints
      ;;
    starts)
      printf '"%s"\n' 'o cloth' '\x0av ' '\x0avt ' frame,time,row,col,x,y,z 'def Mesh \"cloth\"' 'point3f[] points.timeSamples = {' \
        'texCoord2f[] primvars:st = [' 'double3 xformOp:translate = ' 'timeCodesPerSecond = ' POINTCACHE2 glTF POSITION TEXCOORD_0 targets weights
      ;;
    requests)
      printf '"\\x0d\\x0a%s: "\n' Host Origin Authorization Connection Upgrade Sec-WebSocket-Key Sec-WebSocket-Protocol \
        Sec-WebSocket-Version Content-Length Transfer-Encoding
      printf '"%s"\n' Bearer weft.v1 weft.token. token= localhost '[::1]' http:// https:// HTTP/1.1
      ;;
  esac
}

# quoted FILE: the names in a JSON file, with their quotes.
quoted() { grep -ohE '"[a-zA-Z0-9_.-]{2,24}"' "$1" | sort -u | sed 's/"\(.*\)"/"\\"\1\\""/'; }
